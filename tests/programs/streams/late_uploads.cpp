// Uploads that are not needed at once: some are replaced before they are drawn, one texture and one buffer are drawn a
// hundred frames later, some never. The data that a draw uses must be present nevertheless.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kSide = 64, kLate = 100; // delay in frames
enum : unsigned { kLateTexture, kReplaced, kParts, kUnused, kUnchanged, kTextures };
enum : unsigned { kLateBuffer, kReplacedBuffer, kBuffers };
GLuint textures[kTextures], buffers[kBuffers];

std::vector<GLubyte> texels(unsigned seed, int side = kSide) {
    Sequence numbers(seed);
    std::vector<GLubyte> bytes(size_t{4} * size_t(side) * size_t(side));
    for (GLubyte& byte : bytes) byte = numbers.byte();
    return bytes;
}

std::vector<GLfloat> quad(unsigned seed) { // many vertices, in the right half
    Sequence numbers(seed);
    std::vector<GLfloat> points;
    for (int i = 0; i < 300; ++i) points.push_back(numbers.unit()), points.push_back(2 * numbers.unit() - 1);
    return points;
}

void giveTexture(unsigned which, unsigned seed) {
    glBindTexture(GL_TEXTURE_2D, textures[which]);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kSide, kSide, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels(seed).data());
}

void giveBuffer(unsigned which, unsigned seed) {
    const std::vector<GLfloat> points = quad(seed);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[which]);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(points.size() * sizeof(GLfloat)), points.data(), GL_STATIC_DRAW);
}

void setUp(Window&) {
    glGenTextures(kTextures, textures);
    glGenBuffers(kBuffers, buffers);
    for (const GLuint texture : textures) {
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    for (unsigned i = 0; i < kTextures; ++i) giveTexture(i, i + 1);
    giveBuffer(kLateBuffer, 50);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    // State that follows the upload and belongs to it: levels and filters.
    glBindTexture(GL_TEXTURE_2D, textures[kLateTexture]);
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glBindTexture(GL_TEXTURE_2D, textures[kUnchanged]);
}

void drawTextured(unsigned which, float x, float y, float side) {
    glBindTexture(GL_TEXTURE_2D, textures[which]);
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(x, y), glTexCoord2f(1, 0), glVertex2f(x + side, y);
    glTexCoord2f(1, 1), glVertex2f(x + side, y + side), glTexCoord2f(0, 1), glVertex2f(x, y + side);
    glEnd();
    glDisable(GL_TEXTURE_2D);
}

void drawPoints(unsigned which) {
    glBindBuffer(GL_ARRAY_BUFFER, buffers[which]);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(2, GL_FLOAT, 0, nullptr);
    glDrawArrays(GL_POINTS, 0, 300);
    glDisableClientState(GL_VERTEX_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void draw(Window&, int frame) {
    const unsigned seed = 1000 + 10 * unsigned(frame);
    glClear(GL_COLOR_BUFFER_BIT);
    glColor3f(1, 1, 1);
    // Replaced, whole and in parts, in every frame; drawn in every second one.
    for (unsigned i = 0; i < 3; ++i) giveTexture(kReplaced, seed + i), giveBuffer(kReplacedBuffer, seed + i);
    glBindTexture(GL_TEXTURE_2D, textures[kParts]);
    for (unsigned i = 0; i < 4; ++i)
        glTexSubImage2D(GL_TEXTURE_2D, 0, i < 3 ? 0 : 16, 8, 32, 32, GL_RGBA, GL_UNSIGNED_BYTE,
                        texels(seed + 5 + i, 32).data());
    giveTexture(kUnused, seed + 9);
    giveTexture(kUnchanged, kUnchanged + 1); // with unchanged contents
    drawTextured(kUnchanged, -1, -1, 0.5F);
    if (frame % 2 == 1) {
        drawTextured(kReplaced, -1, 0, 0.6F);
        drawTextured(kParts, -0.4F, 0, 0.4F);
        drawPoints(kReplacedBuffer);
    }
    // A texture that is deleted before any draw, and another of its name.
    GLuint gone = 0;
    glGenTextures(1, &gone);
    glBindTexture(GL_TEXTURE_2D, gone);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kSide, kSide, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels(seed).data());
    glDeleteTextures(1, &gone);
    if (frame < kLate) return;
    glColor3f(0.2F, 1, 0.4F);
    drawPoints(kLateBuffer);
    drawTextured(kLateTexture, -0.4F, -1, 0.3F);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
