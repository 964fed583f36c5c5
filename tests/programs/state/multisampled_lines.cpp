// Many short lines of three widths in a window with 4 samples. Where a scissor edge cuts a block of 64x64 pixels,
// Mesa's software driver covers other samples of a line.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.samples = 4;
    return runInGlxWindow(
        argc, argv, spec, [](Window&) {},
        [](Window& window, int frame) {
            Sequence s(static_cast<unsigned>(frame) + 7);
            glViewport(0, 0, window.width(), window.height());
            glClearColor(0.1F, 0.2F, 0.3F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            for (const float width : {7.0F, 3.0F, 1.0F}) {
                glLineWidth(width);
                glBegin(GL_LINES);
                for (int i = 0; i < 3000; ++i) {
                    const float x = 2 * s.unit() - 1, y = 2 * s.unit() - 1;
                    glColor3f(s.unit(), s.unit(), s.unit());
                    glVertex2f(x, y);
                    glVertex2f(x + 0.4F * s.unit() - 0.2F, y + 0.4F * s.unit() - 0.2F);
                }
                glEnd();
            }
        });
}
