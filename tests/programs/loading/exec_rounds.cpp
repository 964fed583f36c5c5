// Draws, then executes or starts itself again in one of several ways, without Mural's additions to its environment.
// There are two rounds.
//   exec_rounds WAY [STAGE DISPLAY]
#include <cstdlib>
#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/programs/loading/drawing_round.hpp"
#include "tests/programs/support/program.hpp"

namespace {

constexpr const char* kSelf = "/proc/self/exe";

[[noreturn]] void endWith(pid_t child) {
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) programs::fail("no child");
    _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 99);
}

[[noreturn]] void goOn(const std::string& way, const std::string& display) {
    const char* w = way.c_str();
    const char* d = display.c_str();
    char* const arguments[] = {const_cast<char*>("exec_rounds"), const_cast<char*>(w), const_cast<char*>("1"),
                               const_cast<char*>(d), nullptr};
    char* const empty[] = {const_cast<char*>("ONLY=this"), nullptr};
    char self[4096] = {};
    if (readlink(kSelf, self, sizeof self - 1) < 0) programs::fail("no name");
    pid_t child = -1;
    if (way == "execl" || way == "execlp")
        unsetenv("LD_PRELOAD");
    else
        clearenv();
    if (way == "execl")
        execl(kSelf, "exec_rounds", w, "1", d, static_cast<char*>(nullptr));
    else if (way == "execlp")
        execlp(self, "exec_rounds", w, "1", d, static_cast<char*>(nullptr));
    else if (way == "execle")
        execle(kSelf, "exec_rounds", w, "1", d, static_cast<char*>(nullptr), empty);
    else if (way == "execv")
        execv(kSelf, arguments);
    else if (way == "execvp")
        execvp(self, arguments);
    else if (way == "execvpe")
        execvpe(self, arguments, empty);
    else if (way == "execve")
        execve(kSelf, arguments, empty);
    else if (way == "fexecve")
        fexecve(open(kSelf, O_RDONLY | O_CLOEXEC), arguments, empty);
    else if (way == "execveat")
        execveat(AT_FDCWD, self, arguments, empty, 0);
    else if (way == "posix_spawn" && posix_spawn(&child, self, nullptr, nullptr, arguments, empty) == 0)
        endWith(child);
    else if (way == "posix_spawnp" && posix_spawnp(&child, self, nullptr, nullptr, arguments, empty) == 0)
        endWith(child);
    else if (way == "vfork" && (child = vfork()) == 0) {
        execve(self, arguments, empty);
        _exit(98);
    } else if (way == "vfork")
        endWith(child);
    else if (way == "system")
        _exit(WEXITSTATUS(system((std::string(self) + " system 1 " + display).c_str())));
    programs::fail("%s did not work", w);
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2 && argc != 4) programs::fail("one or three arguments are needed");
    const std::string way = argv[1], display = argc == 4 ? argv[3] : std::getenv("DISPLAY");
    const int stage = argc == 4 ? 1 : 0;
    programs::drawRound({programs::WindowSystem::Glx, stage, 3, display});
    if (stage == 0) goOn(way, display);
    if (way == "system" && dlopen("libGL.so.1", RTLD_LAZY) != nullptr) sleep(3); // long enough to be observed
    return 6;
}
