// A launcher that forks before any GL call: the child executes this program again, which draws; the parent waits and
// returns its status.
#include <cstring>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "tests/programs/processes/simple_drawing.hpp"

namespace {

int drawFrames(int argc, char** argv) {
    return programs::runInGlxWindow(
        argc, argv, {}, [](programs::Window&) {}, programs::drawSimple);
}

} // namespace

int main(int argc, char** argv) {
    if (argc > 1 && std::strcmp(argv[1], "draw") == 0) {
        return drawFrames(argc - 1, argv + 1);
    }
    const pid_t child = fork();
    if (child == 0) {
        char draw[] = "draw";
        std::vector<char*> arguments(argv, argv + argc);
        arguments.insert(arguments.begin() + 1, draw);
        arguments.push_back(nullptr);
        execv("/proc/self/exe", arguments.data());
        _exit(127);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) {
        programs::fail("the child is lost");
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}
