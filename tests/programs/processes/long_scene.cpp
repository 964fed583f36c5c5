// Many frames that show the results of earlier ones, so a restarted node reveals missing data. Each frame changes a
// part of the textures, and adds to a buffer and to a framebuffer object. The scene also has a display list and a
// query. Prints "frame N T" on standard output before each frame, where T is the time in ms since the previous one.
//
// Environment:
//   SCENE_MIB       MiB of textures (8).
//   SCENE_PAUSE_US  pause in each frame in us (15000).
//   SCENE_KEEPS=1   only the first frame clears, the others draw over the old contents.
//   SCENE_SHARES=1  depth test and many small triangles everywhere, so that --db divides the draws.
//                   Each of up to 4 nodes draws visible ones; an overlay is not divided.
//   SCENE_LISTS=1   calls the display list at many places. Most calls touch few tiles.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <unistd.h>
#include <utility>
#include <vector>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kSide = 1024;  // side of a texture, 4 MiB
constexpr int kChanged = 16; // texels that a frame changes, in each direction
constexpr int kPoints = 4096;
constexpr int kSceneSide = 128;

std::vector<GLuint> textures;
GLuint buffer, list, scene, framebuffer, chips;
constexpr int kChips = 900;

int fromEnvironment(const char* name, int otherwise) {
    const char* text = std::getenv(name);
    return text ? std::atoi(text) : otherwise;
}

bool shares() {
    static const bool does = fromEnvironment("SCENE_SHARES", 0) != 0;
    return does;
}

struct Corner {
    GLfloat x, y, z;
    GLubyte colour[4];
};

// Makes small triangles at few depths, including the depth of the rest. Of equal depths the later triangle is visible.
void makeChips() {
    Sequence numbers(77);
    std::vector<Corner> corners;
    for (int i = 0; i < kChips; ++i) {
        const GLfloat x = 2 * numbers.unit() - 1, y = 2 * numbers.unit() - 1,
                      z = 0.3F * GLfloat(int(numbers.next() % 5) - 2);
        const GLubyte red = numbers.byte(), green = numbers.byte(), blue = numbers.byte();
        for (const auto& [dx, dy] : {std::pair(0.0F, 0.0F), std::pair(0.12F, 0.02F), std::pair(0.03F, 0.14F)})
            corners.push_back({x + dx, y + dy, z, {red, green, blue, 255}});
    }
    glGenBuffers(1, &chips);
    glBindBuffer(GL_ARRAY_BUFFER, chips);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(corners.size() * sizeof(Corner)), corners.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void drawChips(int frame) {
    glBindBuffer(GL_ARRAY_BUFFER, chips);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glVertexPointer(3, GL_FLOAT, sizeof(Corner), nullptr);
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Corner), reinterpret_cast<const void*>(offsetof(Corner, colour)));
    glDrawArrays(GL_TRIANGLES, 0, 3 * (kChips - frame % 50)); // a cost different from the previous frame's
    glDisableClientState(GL_COLOR_ARRAY);
    glDisableClientState(GL_VERTEX_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void setUp(Window&) {
    if (shares()) makeChips();
    textures.resize(size_t(std::max(1, fromEnvironment("SCENE_MIB", 8) / 4)));
    glGenTextures(GLsizei(textures.size()), textures.data());
    std::vector<GLuint> texels(size_t{kSide} * kSide);
    for (size_t i = 0; i < textures.size(); ++i) {
        GLuint value = GLuint(i) * 2654435761U + 1;
        for (GLuint& texel : texels) texel = value = value * 1664525U + 1013904223U;
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kSide, kSide, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    }
    glGenTextures(1, &scene);
    glBindTexture(GL_TEXTURE_2D, scene);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kSceneSide, kSceneSide, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, scene, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, kPoints * 2 * sizeof(GLfloat), nullptr, GL_DYNAMIC_DRAW);
    const std::vector<GLfloat> nothing(size_t{kPoints} * 2, 0.0F);
    glBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(nothing.size() * sizeof(GLfloat)), nothing.data());
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    list = glGenLists(1);
    glNewList(list, GL_COMPILE);
    glColor3f(0.2F, 0.9F, 0.4F);
    glBegin(GL_TRIANGLES);
    glVertex2f(-0.3F, -0.2F);
    glVertex2f(0.4F, -0.1F);
    glVertex2f(0.0F, 0.5F);
    glEnd();
    glEndList();
}

void quad(float left, float bottom, float right, float top) {
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0);
    glVertex2f(left, bottom);
    glTexCoord2f(1, 0);
    glVertex2f(right, bottom);
    glTexCoord2f(1, 1);
    glVertex2f(right, top);
    glTexCoord2f(0, 1);
    glVertex2f(left, top);
    glEnd();
}

// Adds a little to every permanent object.
void grow(int frame) {
    Sequence numbers(unsigned(frame) + 1);
    std::vector<GLubyte> texels(size_t{kChanged} * kChanged * 4);
    for (GLubyte& value : texels) value = numbers.byte();
    glBindTexture(GL_TEXTURE_2D, textures[size_t(frame) % textures.size()]);
    glTexSubImage2D(GL_TEXTURE_2D, 0, GLint(numbers.next() % (kSide - kChanged)),
                    GLint(numbers.next() % (kSide - kChanged)), kChanged, kChanged, GL_RGBA, GL_UNSIGNED_BYTE,
                    texels.data());
    const GLfloat point[] = {2 * numbers.unit() - 1, 2 * numbers.unit() - 1};
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferSubData(GL_ARRAY_BUFFER, GLintptr(size_t(frame % kPoints) * sizeof point), sizeof point, point);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kSceneSide, kSceneSide);
    glDisable(GL_TEXTURE_2D);
    glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
    const float x = 2 * numbers.unit() - 1, y = 2 * numbers.unit() - 1;
    quad(x, y, x + 0.1F, y + 0.1F);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

// Prints the time from the previous frame's beginning to this one's.
void printFrame(int frame) {
    static auto before = std::chrono::steady_clock::now();
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double, std::milli> took = now - std::exchange(before, now);
    std::printf("frame %d %.2f\n", frame, took.count());
    std::fflush(stdout);
}

void draw(Window& window, int frame) {
    printFrame(frame);
    grow(frame);
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.1F, 0.1F, 0.05F * float(frame % 12), 1);
    static const bool keeps = fromEnvironment("SCENE_KEEPS", 0) != 0;
    if (!keeps || frame == 0) glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    if (shares()) {
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LEQUAL);
        drawChips(frame);
    }
    glEnable(GL_TEXTURE_2D);
    glColor3f(1, 1, 1);
    const size_t count = std::min<size_t>(textures.size(), 8);
    for (size_t i = 0; i < count; ++i) {
        glBindTexture(GL_TEXTURE_2D, textures[(size_t(frame) + i * 7) % textures.size()]);
        const float left = -0.95F + 1.9F * float(i) / float(count);
        quad(left, -0.9F, left + 1.8F / float(count), 0.1F);
    }
    glBindTexture(GL_TEXTURE_2D, scene);
    quad(-0.9F, 0.15F, 0.9F, 0.95F);
    glDisable(GL_TEXTURE_2D);
    glPushMatrix();
    glRotatef(float(frame) * 7, 0, 0, 1);
    glCallList(list);
    glPopMatrix();
    static const bool callsLists = fromEnvironment("SCENE_LISTS", 0) != 0;
    for (int i = 0; callsLists && i < 24; ++i) {
        glPushMatrix();
        glTranslatef(0.08F * float(i) - 0.9F, 0.3F * float((i + frame) % 7) - 0.9F, 0);
        glScalef(0.1F, 0.1F, 1);
        glCallList(list);
        glPopMatrix();
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(2, GL_FLOAT, 0, nullptr);
    glColor3f(1, 0.8F, 0.1F);
    glDrawArrays(GL_POINTS, 0, shares() ? frame % kPoints : kPoints);
    glDisableClientState(GL_VERTEX_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    if (shares()) { // transparent
        glDisable(GL_DEPTH_TEST);
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        glColor4f(0.3F, 0, 0.6F, 0.4F);
        quad(-0.5F, -0.5F, 0.1F, 0.1F);
        glDisable(GL_BLEND);
    }
    static const int pauseUs = fromEnvironment("SCENE_PAUSE_US", 15000);
    usleep(useconds_t(pauseUs));
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
