// The accumulation buffer: jittered frames, all operations, scissored, read by drawing.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

void drawShapes(int frame, float dx, float dy) {
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glTranslatef(dx, dy, 0);
    Sequence numbers(unsigned(frame) + 17);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 30; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 250, numbers.unit() * 190);
    }
    glEnd();
}

void accumulate(Window& window, int frame) {
    glClearAccum(0.05F, 0.1F, 0, 0);
    glClear(GL_ACCUM_BUFFER_BIT);
    constexpr int kSteps = 4;
    for (int step = 0; step < kSteps; ++step) {
        glClear(GL_COLOR_BUFFER_BIT);
        drawShapes(frame, float(step % 2) * 0.5F, float(step / 2) * 0.5F + float(frame));
        glAccum(step == 0 && frame % 2 == 1 ? GL_LOAD : GL_ACCUM, 1.0F / kSteps);
    }
    glEnable(GL_SCISSOR_TEST);
    glScissor(window.width() / 4, window.height() / 4, window.width() / 3, window.height() / 3);
    glAccum(GL_MULT, 0.6F);
    glAccum(GL_ADD, 0.1F + 0.05F * float(frame));
    glDisable(GL_SCISSOR_TEST);
    glClearColor(0.4F, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glAccum(GL_RETURN, 1);
    glEnable(GL_SCISSOR_TEST);
    glScissor(window.width() / 2, window.height() / 2, window.width() / 3, window.height() / 3);
    glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE);
    glAccum(GL_RETURN, 0.7F);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(0.1F, 0.1F, 0.3F, 1);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.accum = 16;
    spec.alpha = 8;
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            glClearColor(0.1F, 0.1F, 0.3F, 1);
            GLint bits = 0;
            glGetIntegerv(GL_ACCUM_RED_BITS, &bits);
            if (bits == 0) {
                fail("the window has no accumulation buffer");
            }
        },
        [](Window& window, int frame) {
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            accumulate(window, frame);
        });
}
