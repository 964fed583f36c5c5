// Draws into and reads from the front buffer of a window with two buffers. The pixels read are shown in the next frame.
// Only pixels drawn into the front buffer are read, because Mesa 22's software drivers do not copy swapped pictures
// into it.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kWidth = 80, kHeight = 60;

void drawTriangles(unsigned seed) {
    Sequence numbers(seed);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 24; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 1.6F - 0.8F, numbers.unit() * 1.6F - 0.8F);
    }
    glEnd();
}

// Draws a part of the front buffer completely, and reads it.
std::vector<GLubyte> overlay(Window& window, int frame, GLenum buffer) {
    const int x = window.width() / 4 + frame * 3;
    const int y = window.height() / 4;
    glDrawBuffer(buffer);
    glEnable(GL_SCISSOR_TEST);
    glScissor(x, y, kWidth, kHeight);
    glClearColor(0.8F, 0.7F, 0.2F * float(frame % 5), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    drawTriangles(unsigned(frame) + (buffer == GL_FRONT ? 50 : 80));
    glDisable(GL_SCISSOR_TEST);
    glFlush();
    std::vector<GLubyte> pixels(kWidth * kHeight * 4);
    glReadBuffer(buffer);
    glReadPixels(x, y, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    checkNoError("in the front buffer");
    return pixels;
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    std::vector<GLubyte> overlays[2];
    for (int frame = 0; frame < options.frames; ++frame) {
        glDrawBuffer(GL_BACK);
        glClearColor(0.2F, 0.1F, 0.1F * float(frame % 5), 1);
        glClear(GL_COLOR_BUFFER_BIT);
        drawTriangles(unsigned(frame) + 1);
        for (int i = 0; i < 2 && frame > 0; ++i) {
            glWindowPos2i(5 + i * 90, 5);
            glDrawPixels(kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, overlays[i].data());
        }
        checkNoError("in the back buffer");
        window->swap();
        overlays[0] = overlay(*window, frame, GL_FRONT);
        overlays[1] = overlay(*window, frame, GL_FRONT_LEFT);
    }
    return 0;
}
