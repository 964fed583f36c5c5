#include "nodes/launch/child_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/log/log.hpp"

namespace mural::launch {

namespace {

struct RememberedSignals {
    bool known = false;
    sigset_t mask{};
    struct sigaction pipe {};
    struct sigaction fileSize {};
};
RememberedSignals remembered;

std::vector<char*> pointers(const std::vector<std::string>& strings) {
    std::vector<char*> all;
    all.reserve(strings.size() + 1);
    for (const std::string& s : strings) all.push_back(const_cast<char*>(s.c_str()));
    all.push_back(nullptr);
    return all;
}

bool redirect(int from, int to) { return from < 0 || dup2(from, to) >= 0; }

// Runs in the child, between fork and exec, with async-signal-safe calls only.
[[noreturn]] void becomeProgram(const SpawnRequest& request, char** arguments, char** environment, pid_t parent,
                                int reportFd) {
    if (request.ownSession) setsid();
    if (request.signalWhenWeDie != 0) {
        prctl(PR_SET_PDEATHSIG, request.signalWhenWeDie);
        if (getppid() != parent) _exit(127); // the parent died before PR_SET_PDEATHSIG took effect
    }
    if (remembered.known) {
        sigprocmask(SIG_SETMASK, &remembered.mask, nullptr);
        sigaction(SIGPIPE, &remembered.pipe, nullptr);
        sigaction(SIGXFSZ, &remembered.fileSize, nullptr);
    }
    bool ready = redirect(request.inputFd, 0) && redirect(request.outputFd, 1) && redirect(request.errorFd, 2);
    for (const int fd : request.inheritedFds) ready = ready && fcntl(fd, F_SETFD, 0) == 0;
    if (ready) execvpe(request.file.c_str(), arguments, environment);
    const int reason = errno;
    [[maybe_unused]] const ssize_t written = write(reportFd, &reason, sizeof reason);
    _exit(127);
}

// 0: exec worked (the pipe closed without a word); otherwise errno of the child.
int reasonFrom(int fd) {
    int reason = 0;
    ssize_t n = 0;
    do {
        n = read(fd, &reason, sizeof reason);
    } while (n < 0 && errno == EINTR);
    return n == sizeof reason ? reason : 0;
}

} // namespace

void rememberSignals() {
    if (remembered.known) return; // later calls would save the handlers of this process
    sigprocmask(SIG_SETMASK, nullptr, &remembered.mask);
    sigaction(SIGPIPE, nullptr, &remembered.pipe);
    sigaction(SIGXFSZ, nullptr, &remembered.fileSize);
    remembered.known = true;
}

Result<ChildProcess> ChildProcess::start(const SpawnRequest& request) {
    int report[2];
    if (pipe2(report, O_CLOEXEC) != 0)
        return Error{"cannot create a pipe for a process: " + std::string(std::strerror(errno))};
    auto arguments = pointers(request.arguments);
    auto environment = pointers(request.environment);
    const pid_t parent = getpid();
    const pid_t pid = fork();
    if (pid == 0) becomeProgram(request, arguments.data(), environment.data(), parent, report[1]);
    const int forkReason = errno;
    close(report[1]);
    if (pid < 0) {
        close(report[0]);
        return Error{"cannot create a process for " + request.file + ": " + std::strerror(forkReason)};
    }
    const int reason = reasonFrom(report[0]);
    close(report[0]);
    log::debug(log::Topic::Launch, reason != 0 ? "cannot start " : "started ", request.file, ", pid ", pid);
    if (reason != 0) {
        while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {}
        return Error{request.file + " cannot be executed: " + std::strerror(reason)};
    }
    ChildProcess child = adopt(pid);
    child.ownSession_ = request.ownSession;
    return child;
}

ChildProcess ChildProcess::adopt(pid_t pid) {
    ChildProcess child;
    child.pid_ = pid;
    child.running_ = true;
    return child;
}

bool ChildProcess::running() {
    if (!running_) return false;
    int status = 0;
    const pid_t got = waitpid(pid_, &status, WNOHANG);
    if (got == 0 || (got < 0 && errno == EINTR)) return true;
    running_ = false;
    if (got == pid_ && WIFSIGNALED(status)) {
        endSignal_ = WTERMSIG(status);
        exitStatus_ = 128 + endSignal_;
    } else if (got == pid_) {
        exitStatus_ = WEXITSTATUS(status);
    }
    if (log::enabled(log::Topic::Launch, log::Level::Debug))
        log::debug(log::Topic::Launch, "process ", pid_, " has ended: ", describeEnd());
    return false;
}

std::string ChildProcess::describeEnd() const {
    return launch::describeEnd(endSignal_ != 0 ? endSignal_ : W_EXITCODE(exitStatus_, 0));
}

std::string describeEnd(int waitStatus) {
    if (!WIFSIGNALED(waitStatus)) return "exit status " + std::to_string(WEXITSTATUS(waitStatus));
    const int signal = WTERMSIG(waitStatus);
    return "signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
}

void ChildProcess::signal(int number) {
    if (running()) kill(pid_, number);
}

void ChildProcess::signalGroup(int number) {
    if (ownSession_ && pid_ > 0) kill(-pid_, number);
}

bool ChildProcess::waitUntil(Deadline deadline) {
    constexpr int kSliceMs = 5;
    while (running()) {
        if (deadline.passed()) return false;
        poll(nullptr, 0, kSliceMs);
    }
    return true;
}

void ChildProcess::end(Deadline deadline) {
    signal(SIGTERM);
    if (!waitUntil(deadline)) {
        signal(SIGKILL);
        waitUntil(Deadline::inMs(2000));
    }
}

} // namespace mural::launch
