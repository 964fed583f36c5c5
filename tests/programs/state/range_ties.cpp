// Sort-last: equal depths of draws of different nodes, with each depth function for which nodes divide draws; a sky at
// the clear depth; drawing after opaque draws; draws cut into pieces; a picture read in the middle.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <GL/glext.h>
#include <vector>

using namespace programs;

namespace {

struct Vertex {
    float x, y, z;
    unsigned char r, g, b, a;
};

// Returns strips at equal depths on top of each other: the draw order decides which colour is visible.
std::vector<Vertex> strips(int frame, float z) {
    std::vector<Vertex> all;
    for (int i = 0; i < 60; ++i) {
        const float x = -1 + 0.03F * static_cast<float>(i), w = 0.4F;
        const auto shade = [&](int k) { return static_cast<unsigned char>((i * 37 + k * 91 + frame * 11) % 256); };
        const Vertex corner{x, -0.9F, z, shade(0), shade(1), shade(2), 255};
        Vertex right = corner, top = corner;
        right.x += w;
        top.y = 0.9F - 0.02F * static_cast<float>(i % 7);
        all.insert(all.end(), {corner, right, top});
    }
    return all;
}

void draw(const std::vector<Vertex>& v, bool elements) {
    glVertexPointer(3, GL_FLOAT, sizeof(Vertex), &v[0].x);
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), &v[0].r);
    if (!elements) return glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(v.size()));
    std::vector<GLushort> indices;
    for (size_t i = 0; i < v.size(); ++i) indices.push_back(static_cast<GLushort>(v.size() - 1 - i));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices.size()), GL_UNSIGNED_SHORT, indices.data());
}

void sky(float depth) {
    glBegin(GL_QUADS);
    for (const auto& [x, y] :
         {std::pair(-1.0F, -1.0F), std::pair(1.0F, -1.0F), std::pair(1.0F, 1.0F), std::pair(-1.0F, 1.0F)}) {
        glColor3f(0.2F, 0.4F + 0.2F * y, 0.7F + 0.2F * x);
        glVertex3f(x, y, depth);
    }
    glEnd();
}

void frame(int number) {
    const struct {
        GLenum function;
        double clear;
        float sky;
    } kCases[] = {{GL_LESS, 1, 0.999F}, {GL_LEQUAL, 1, 1}, {GL_GREATER, 0, -0.999F}, {GL_GEQUAL, 0, -1}};
    const auto& c = kCases[number % 4];
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(c.function);
    glClearDepth(c.clear);
    glClearColor(0.1F, 0.1F, 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    for (int i = 0; i < 4; ++i) draw(strips(i, 0.25F), i % 2 != 0);
    draw(strips(9, 0.3F), false);
    sky(c.sky);
    if (number % 2 != 0) { // the picture is needed while it is drawn
        unsigned char pixel[4];
        glReadPixels(20, 20, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
        glColor3ub(pixel[0], pixel[1], pixel[2]);
        glRectf(-0.95F, -0.95F, -0.9F, -0.9F);
    }
    glEnable(GL_BLEND); // and an overlay
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDisable(GL_DEPTH_TEST);
    glColor4f(1, 1, 0, 0.3F);
    glRectf(-0.5F, -0.5F, 0.6F, 0.4F);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    draw(strips(3, 0.2F), true); // opaque again: on one node
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableClientState(GL_COLOR_ARRAY);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) {}, [](Window&, int number) { frame(number); });
}
