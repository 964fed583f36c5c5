// Allocates textures until GL_OUT_OF_MEMORY is reported. Calls of a few more frames may have failed by then; later ones
// raise no error. Prints "frame N" after each frame, and "no memory" at the report.
#include <cstdio>
#include <unistd.h>

#include "tests/programs/processes/simple_drawing.hpp"
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"

using namespace programs;

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    int reportedFrame = -1; // frame of the report
    for (int frame = 0; frame < options.frames; ++frame) {
        drawSimple(*window, frame);
        if (reportedFrame < 0) {
            GLuint texture = 0;
            glGenTextures(1, &texture);
            glBindTexture(GL_TEXTURE_2D, texture);
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 1024, 1024, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
            glBindTexture(GL_TEXTURE_2D, 0);
        }
        const GLenum error = glGetError();
        if (error == GL_OUT_OF_MEMORY && reportedFrame < 0) {
            reportedFrame = frame;
            std::printf("no memory\n");
        } else if (error != GL_NO_ERROR && (error != GL_OUT_OF_MEMORY || frame > reportedFrame + 3)) {
            fail("GL error 0x%04x in frame %d", error, frame);
        }
        window->swap();
        std::printf("frame %d\n", frame);
        std::fflush(stdout);
        usleep(2000);
    }
    return 0;
}
