// Forks children in the middle of drawing: one ends at once with _exit, one executes another program, one lives for a
// while without using the parent's GL. The parent continues to draw.
#include <sys/wait.h>
#include <unistd.h>

#include "tests/programs/processes/simple_drawing.hpp"

namespace {

pid_t startChild(int kind) {
    const pid_t child = fork();
    if (child != 0) {
        return child;
    }
    if (kind == 1) {
        execl("/bin/true", "true", static_cast<char*>(nullptr));
    }
    if (kind == 2) {
        usleep(20000);
    }
    _exit(0);
}

} // namespace

int main(int argc, char** argv) {
    return programs::runInGlxWindow(
        argc, argv, {}, [](programs::Window&) {},
        [](programs::Window& window, int frame) {
            const pid_t child = startChild(frame % 3);
            programs::drawSimple(window, frame);
            int status = 0;
            if (child < 0 || waitpid(child, &status, 0) != child || status != 0) {
                programs::fail("a child did not end as it should: status %d", status);
            }
        });
}
