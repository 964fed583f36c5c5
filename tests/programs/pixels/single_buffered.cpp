// A window with one buffer: pictures grow without being cleared, shown by glFlush and glFinish.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    WindowSpec spec;
    spec.doubleBuffered = false;
    const auto window = openGlxWindow(spec, options.width, options.height);
    window->makeCurrent();
    glClearColor(0.1F, 0.2F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    for (int frame = 0; frame < options.frames; ++frame) {
        Sequence numbers{unsigned(frame)};
        glBegin(GL_TRIANGLES);
        for (int i = 0; i < 9; ++i) {
            glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
            glVertex2f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
        }
        glEnd();
        checkNoError("in a single buffer");
        if (frame % 2 == 0) {
            glFlush();
        } else {
            glFinish();
        }
    }
    return 0;
}
