// OpenGL after main() has returned: in a handler of atexit and in a destructor of the program. Prints what they read and see.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

Window* window; // its owner ends last

void draw(int frame) {
    glViewport(0, 0, window->width(), window->height());
    glClearColor(0.1F * float(frame % 9), 0.4F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    showBits(1, std::uint32_t(frame * 77));
    showBar(3, frame * 9);
}

void printRead(const char* what) {
    std::vector<GLubyte> pixels(std::size_t(window->width()) * std::size_t(window->height()) * 4);
    glReadPixels(0, 0, window->width(), window->height(), GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    std::uint64_t sum = 0;
    for (const GLubyte byte : pixels) {
        sum = (sum ^ byte) * 1099511628211ULL;
    }
    std::printf("%s reads %016llx, error %x\n", what, static_cast<unsigned long long>(sum), glGetError());
    std::fflush(stdout);
}

void showFrames(const char* what, int first, int count) {
    for (int frame = first; frame < first + count; ++frame) {
        draw(frame);
        printRead(what);
        window->swap();
    }
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
    std::atexit(atExit); // before the driver has registered handlers of its own
    window = MURAL_OPEN({}, options.width, options.height).release();
    window->makeCurrent();
    showFrames("in main", 0, 3);
    return 9;
}
