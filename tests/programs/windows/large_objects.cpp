// Some 200 MiB of permanent objects: textures with and without mipmaps, buffers, a long display list. A process that
// keeps a second copy of forwarded data, or does not free it after sending, uses more memory.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kTextures = 4, kTextureSize = 2048; // 16 MiB each, one of them with mipmaps
constexpr int kBuffers = 4;
constexpr int kPoints = 2'000'000; // 8 bytes each: 16 MiB per buffer
constexpr int kListVertices = 300'000;

GLuint textures[kTextures], buffers[kBuffers], list;

void makeTextures() {
    std::vector<GLubyte> texels(size_t{4} * kTextureSize * kTextureSize);
    glGenTextures(kTextures, textures);
    for (int i = 0; i < kTextures; ++i) {
        Sequence numbers(unsigned(i) + 3);
        GLubyte value = 0;
        for (size_t at = 0; at < texels.size(); ++at) texels[at] = at % 64 == 0 ? value = numbers.byte() : value;
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, i == 0 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kTextureSize, kTextureSize, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     texels.data());
        if (i == 0) glGenerateMipmap(GL_TEXTURE_2D);
    }
}

void makeBuffers() {
    std::vector<GLfloat> points(size_t{2} * kPoints);
    glGenBuffers(kBuffers, buffers);
    for (int i = 0; i < kBuffers; ++i) {
        Sequence numbers(unsigned(i) + 30);
        for (GLfloat& value : points) value = 2 * numbers.unit() - 1;
        glBindBuffer(GL_ARRAY_BUFFER, buffers[i]);
        glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(points.size() * sizeof(GLfloat)), points.data(), GL_STATIC_DRAW);
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void makeList() {
    Sequence numbers(7);
    list = glGenLists(1);
    glNewList(list, GL_COMPILE);
    glBegin(GL_POINTS);
    for (int i = 0; i < kListVertices; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), 0.5F);
        glVertex2f(numbers.unit(), numbers.unit());
    }
    glEnd();
    glEndList();
}

void setUp(Window&) {
    makeTextures();
    makeBuffers();
    makeList();
}

void draw(Window&, int frame) {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBindTexture(GL_TEXTURE_2D, textures[frame % kTextures]);
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(-1, -1), glTexCoord2f(1, 0), glVertex2f(0, -1);
    glTexCoord2f(1, 1), glVertex2f(0, 0), glTexCoord2f(0, 1), glVertex2f(-1, 0);
    glEnd();
    glDisable(GL_TEXTURE_2D);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[frame % kBuffers]);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(2, GL_FLOAT, 0, nullptr);
    glColor3f(0.9F, 0.8F, 0.1F * float(frame % 9));
    glDrawArrays(GL_POINTS, frame * 1000 % kPoints, 1000);
    glDisableClientState(GL_VERTEX_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glCallList(list);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
