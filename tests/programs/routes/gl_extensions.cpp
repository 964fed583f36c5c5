// Prints GL_EXTENSIONS, as one text and name by name, in the reported order.
#include <cstdio>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"

using namespace programs;

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {Profile::Compatibility, 4, 5}, [](Window&) {},
        [](Window&, int frame) {
            if (frame > 0) {
                return;
            }
            std::printf("text %s\n", reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS)));
            GLint count = 0;
            glGetIntegerv(GL_NUM_EXTENSIONS, &count);
            std::printf("names");
            for (GLint i = 0; i < count; ++i) {
                std::printf(" %s", reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i))));
            }
            std::printf("\n");
            checkNoError("after the extensions");
            const GLubyte* const beyond = glGetStringi(GL_EXTENSIONS, GLuint(count));
            const GLenum error = glGetError();
            std::printf("beyond %s 0x%04x\n", beyond != nullptr ? "something" : "nothing", error);
        });
}
