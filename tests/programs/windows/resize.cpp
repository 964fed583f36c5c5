// The window changes its size between frames, larger and smaller, with and without a new viewport.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

void draw(Window& window, int frame) {
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.1F, 0.1F * float(frame % 4), 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(0, window.width(), 0, window.height(), -1, 1);
    // A frame at the outermost pixels, and a grid: both reveal a wrong size.
    const float w = float(window.width());
    const float h = float(window.height());
    glColor3f(1, 1, 1);
    glBegin(GL_LINE_LOOP);
    glVertex2f(0.5F, 0.5F), glVertex2f(w - 0.5F, 0.5F), glVertex2f(w - 0.5F, h - 0.5F), glVertex2f(0.5F, h - 0.5F);
    glEnd();
    glBegin(GL_LINES);
    for (float x = 10.5F; x < w; x += 20) {
        glColor3f(x / w, 0.8F, 0.2F);
        glVertex2f(x, 2), glVertex2f(x + 5, h - 2);
    }
    glEnd();
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    showBits(3, std::uint32_t(viewport[2] * 65536 + viewport[3]));
}

} // namespace

int main(int argc, char** argv) {
    Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    const int percents[][2] = {{100, 100}, {130, 90}, {60, 120}, {61, 77}, {100, 100}};
    for (int frame = 0; frame < options.frames; ++frame) {
        if (frame > 0) {
            const auto& percent = percents[frame % 5];
            window->resize(options.width * percent[0] / 100, options.height * percent[1] / 100);
        }
        draw(*window, frame);
        checkNoError("after a resize");
        window->swap();
    }
    return 0;
}
