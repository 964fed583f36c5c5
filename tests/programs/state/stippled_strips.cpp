// Stippled line strips through the near plane, with arrays, glBegin and display lists. Mesa restarts the pattern with a
// strip's first segment only if that segment is not clipped away. Otherwise the pattern continues where the last
// stippled line ended, possibly in an earlier draw or frame. Each draw's picture therefore depends on all earlier
// stippled draws.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kStrips = 40, kVertices = 30;
GLuint list;

// Returns a strip whose first two vertices lie behind the eye.
std::vector<float> strip(Sequence& s) {
    std::vector<float> v;
    for (int i = 0; i < kVertices; ++i) {
        const float depth = i < 2 ? 1.0F + s.unit() : 3.0F - 8.0F * s.unit();
        v.insert(v.end(), {10 * s.unit() - 5, 10 * s.unit() - 5, depth});
    }
    return v;
}

void byBegin(const std::vector<float>& v, GLenum mode) {
    glBegin(mode);
    for (std::size_t i = 0; i < v.size(); i += 3) glVertex3fv(&v[i]);
    glEnd();
}

void byArrays(const std::vector<float>& v, GLenum mode) {
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, v.data());
    glDrawArrays(mode, 0, static_cast<GLsizei>(v.size() / 3));
    glDisableClientState(GL_VERTEX_ARRAY);
}

void setUp(Window&) {
    Sequence s(5);
    list = glGenLists(1);
    glNewList(list, GL_COMPILE);
    glColor3f(1, 1, 1);
    byBegin(strip(s), GL_LINE_STRIP);
    glEndList();
}

void draw(Window& window, int frame) {
    Sequence s(static_cast<unsigned>(frame) + 1);
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(-0.5, 0.5, -0.5, 0.5, 0.5, 50);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glEnable(GL_LINE_STIPPLE);
    for (int i = 0; i < kStrips; ++i) {
        glLineStipple(1 + i % 3, i % 2 == 0 ? 0x3f07 : 0x00ff);
        glLineWidth(i % 4 == 0 ? 3.0F : 1.0F);
        glColor3f(s.unit(), s.unit(), s.unit());
        const GLenum mode = i % 5 == 0 ? GL_LINE_LOOP : i % 7 == 0 ? GL_LINES : GL_LINE_STRIP;
        if (i % 8 == 0) glCallList(list);
        i % 2 == 0 ? byArrays(strip(s), mode) : byBegin(strip(s), mode);
    }
    glDisable(GL_LINE_STIPPLE);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
