// The main loop for GLX, in a file of its own so that a program links only the window system that it uses.
#include "tests/programs/support/program.hpp"

namespace programs {

int runInGlxWindow(int argc, char** argv, const WindowSpec& spec, const Setup& setup, const Draw& draw) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow(spec, options.width, options.height);
    window->makeCurrent();
    setup(*window);
    checkNoError("while setting up");
    runFrames(*window, options, draw);
    window->release();
    return 0;
}

} // namespace programs
