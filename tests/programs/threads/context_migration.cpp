// One window and one context that move between threads: another thread draws each frame, and the state stays with the
// context.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <thread>

using namespace programs;

namespace {

void drawFrame(Window& window, int frame) {
    window.makeCurrent();
    if (frame == 0) {
        glMatrixMode(GL_PROJECTION);
        glLoadIdentity();
        glOrtho(0, 100, 0, 100, -1, 1);
        glMatrixMode(GL_MODELVIEW);
        glLineWidth(3);
        glShadeModel(GL_FLAT);
    }
    glRotatef(8, 0, 0, 1); // added to the matrix of the last thread
    glColor3f(0.2F * float(frame % 5), 0.8F, 0.4F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBegin(GL_TRIANGLE_STRIP);
    for (int i = 0; i < 12; ++i) {
        glVertex2f(float(20 + i * 5), float(10 + (i % 2) * 40 + i));
        glColor3f(float(i) / 12, 0.3F, 0.9F);
    }
    glEnd();
    glBegin(GL_LINE_STRIP);
    for (int i = 0; i < 8; ++i) {
        glVertex2f(float(25 + i * 9), float(60 + (i * 37) % 20));
    }
    glEnd();
    glClearColor(0.1F * float(frame % 4), 0.1F, 0.1F, 1); // the next thread clears with it
    checkNoError("in one of the threads");
    window.swap();
    window.release();
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    for (int frame = 0; frame < options.frames; ++frame) {
        if (frame % 3 == 0) {
            drawFrame(*window, frame);
        } else {
            std::thread(drawFrame, std::ref(*window), frame).join();
        }
    }
    return 0;
}
