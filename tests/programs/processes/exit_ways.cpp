// Ends in the way that its name selects: exit_dirty (exit, nothing destroyed), exit_quick (_exit), exit_three (status
// 3), exit_abort (abort after the frames), exit_segv, exit_term (SIGTERM to itself).
#include <csignal>
#include <cstdlib>
#include <string>
#include <unistd.h>

#include "tests/programs/processes/simple_drawing.hpp"

int main(int argc, char** argv) {
    const programs::Options options = programs::parseOptions(argc, argv);
    auto* window = programs::openGlxWindow({}, options.width, options.height).release();
    window->makeCurrent();
    programs::runFrames(*window, options, programs::drawSimple);
    const std::string way = MURAL_EXIT_WAY;
    if (way == "quick") {
        _exit(0);
    } else if (way == "three") {
        std::exit(3);
    } else if (way == "abort") {
        std::abort();
    } else if (way == "segv") {
        std::raise(SIGSEGV);
    } else if (way == "term") {
        std::raise(SIGTERM);
    }
    std::exit(0);
}
