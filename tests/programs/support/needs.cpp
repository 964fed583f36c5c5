#include "tests/programs/support/needs.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/programs/support/gl.hpp"

namespace programs {

void needExtension(const char* name) {
    constexpr int kSkipped = 77;
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        if (std::strcmp(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i))), name) == 0) {
            return;
        }
    }
    std::printf("skipped: %s has no %s\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)), name);
    std::fflush(stdout);
    std::_Exit(kSkipped);
}

} // namespace programs
