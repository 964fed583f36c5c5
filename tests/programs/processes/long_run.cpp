// Draws many frames, or the number given with --frames, with a short pause after each, while tests kill other
// processes. Prints "frame N" after each frame, so that a test can follow the progress.
#include <cstdio>
#include <unistd.h>

#include "tests/programs/processes/simple_drawing.hpp"

int main(int argc, char** argv) {
    return programs::runInGlxWindow(
        argc, argv, {}, [](programs::Window&) {},
        [](programs::Window& window, int frame) {
            programs::drawSimple(window, frame);
            std::printf("frame %d\n", frame);
            std::fflush(stdout);
            usleep(15000); // a session without pauses takes the CPU time of other tests
        });
}
