// The part of the frame loop that calls GL: apart, so that a program may link no GL library at all.
#include <GL/gl.h>
#include <cstdio>

#include "tests/programs/support/program.hpp"

namespace programs {

void checkNoError(const char* where) {
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) {
        fail("GL error 0x%04x %s", error, where);
    }
}

void runFrame(Window& window, int frame, const Draw& draw) {
    draw(window, frame);
    char where[40];
    std::snprintf(where, sizeof where, "in frame %d", frame);
    checkNoError(where);
    window.swap();
}

void runFrames(Window& window, const Options& options, const Draw& draw) {
    for (int frame = 0; frame < options.frames; ++frame) runFrame(window, frame, draw);
}

} // namespace programs
