// Draws many frames unless --frames says otherwise, a short pause after each: something to kill other
// processes under. Says "frame N" on standard output after each, so that a test knows where it is.
#include <cstdio>
#include <unistd.h>

#include "tests/programs/processes/simple_drawing.hpp"

int main(int argc, char** argv) {
    return programs::runInGlxWindow(
        argc,
        argv,
        {},
        [](programs::Window&) {},
        [](programs::Window& window, int frame) {
            programs::drawSimple(window, frame);
            std::printf("frame %d\n", frame);
            std::fflush(stdout);
            usleep(5000);
        });
}
