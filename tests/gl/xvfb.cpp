#include "tests/gl/xvfb.hpp"

#include <cstdlib>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace mural::test {
namespace {

constexpr int kStartDeadlineMs = 30000;

// The server writes its number and a newline once it listens.
std::string readNumber(int fd) {
    std::string number;
    for (;;) {
        pollfd ready{fd, POLLIN, 0};
        if (poll(&ready, 1, kStartDeadlineMs) != 1) return "";
        char next = 0;
        if (read(fd, &next, 1) != 1) return "";
        if (next == '\n') return number;
        number += next;
    }
}

void becomeServer(int numberFd) {
    prctl(PR_SET_PDEATHSIG, SIGKILL); // a test that crashes leaves no server behind
    const int null = ::open("/dev/null", O_RDWR);
    dup2(null, 1);
    dup2(null, 2);
    const std::string fd = std::to_string(numberFd);
    execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-noreset",
           "+extension", "GLX", static_cast<char*>(nullptr));
    _exit(127);
}

} // namespace

Xvfb::~Xvfb() {
    if (process_ <= 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
}

Result<void> Xvfb::start() {
    int ends[2];
    if (pipe(ends) != 0) return Error{"can't make a pipe for Xvfb's display number"};
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    process_ = fork();
    if (process_ == 0) becomeServer(ends[1]);
    close(ends[1]);
    const std::string number = readNumber(ends[0]);
    close(ends[0]);
    if (number.empty()) return Error{"Xvfb does not start: install the package xvfb"};
    display_ = ":" + number;
    setenv("DISPLAY", display_.c_str(), 1);
    return {};
}

} // namespace mural::test
