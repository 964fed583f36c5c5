// OpenGL after main() has returned: in an atexit handler and in a destructor of the program. Nothing is read, because
// Mesa frees memory that reads need at exit, so that some of them crash natively.
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

Window* window; // destroyed last

void draw(int frame) {
    glViewport(0, 0, window->width(), window->height());
    glClearColor(0.1F * float(frame % 9), 0.4F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    showBits(1, std::uint32_t(frame * 77));
    showBar(3, frame * 9);
}

void showFrames(const char* what, int first, int count) {
    for (int frame = first; frame < first + count; ++frame) {
        draw(frame);
        window->swap();
    }
    std::printf("%s: %d frames\n", what, count);
    std::fflush(stdout);
}

void atExit() { showFrames("at exit", 10, 4); }

__attribute__((destructor)) void inDestructor() {
    if (window != nullptr) {
        showFrames("in a destructor", 20, 2);
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    std::atexit(atExit); // registered before the driver's own handlers
    window = MURAL_OPEN(MURAL_SPEC, options.width, options.height).release();
    window->makeCurrent();
    showFrames("in main", 0, 3);
    return 9;
}
