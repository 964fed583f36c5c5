// The part of the frame loop that calls GL, separate so that a program can link no GL library at all.
#include <GL/gl.h>
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/programs/support/program.hpp"

namespace programs {

void checkNoError(const char* where) {
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) {
        fail("GL error 0x%04x %s", error, where);
    }
}

namespace {

void runFrame(Window& window, int frame, const Draw& draw) {
    draw(window, frame);
    char where[40];
    std::snprintf(where, sizeof where, "in frame %d", frame);
    checkNoError(where);
    window.swap();
}

// Returns the total number of frames, as known before this one.
int framesInAll(int frame, int maximum) {
    static const char* path = std::getenv("END_FILE");
    static int inAll = maximum;
    std::FILE* file = path ? std::fopen(path, "r") : nullptr;
    if (!file) return inAll;
    int more = 0;
    if (std::fscanf(file, "%d", &more) != 1) fail("no number of frames in %s", path);
    std::fclose(file);
    path = nullptr; // once
    return inAll = std::min(maximum, frame + more);
}

} // namespace

void runFrames(Window& window, const Options& options, const Draw& draw) {
    for (int frame = 0; frame < framesInAll(frame, options.frames); ++frame) runFrame(window, frame, draw);
}

} // namespace programs
