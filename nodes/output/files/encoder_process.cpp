#include "nodes/output/files/encoder_process.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

extern char** environ;

namespace mural {

namespace {

constexpr int64_t kWaitSliceNs = 20 * kNsPerMs; // for kernels without pidfd_open
constexpr int kUnknownStatus = 255 << 8;        // stands for exit status 255
constexpr int64_t kTermGraceMs = 2000;
constexpr int kInputBufferBytes = 1 << 20;
constexpr size_t kLargestText = size_t{4} << 20;

int pollMs(int64_t ns) { return static_cast<int>(std::min<int64_t>((ns + kNsPerMs - 1) / kNsPerMs, 60'000)); }

void closeFd(int& fd) {
    if (fd >= 0) ::close(fd);
    fd = -1;
}

std::string textOf(int fd) {
    struct stat status {};
    if (fd < 0 || ::fstat(fd, &status) != 0) return {};
    std::string text(std::min(static_cast<size_t>(status.st_size), kLargestText), '\0');
    const ssize_t read = ::pread(fd, text.data(), text.size(), 0);
    text.resize(read < 0 ? 0 : static_cast<size_t>(read));
    return text;
}

// The reason is in one of the last two lines: ffmpeg's last line is often only a consequence.
std::string lastLines(const std::string& text) {
    std::string last;
    std::string beforeLast;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        begin = end + 1;
        if (line.empty() || line.find("Last message repeated") != std::string::npos) continue;
        beforeLast = std::exchange(last, line);
    }
    return beforeLast.empty() ? last : beforeLast + "; " + last;
}

struct SpawnSettings {
    SpawnSettings() {
        posix_spawn_file_actions_init(&actions);
        posix_spawnattr_init(&attributes);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;
    ~SpawnSettings() {
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_t actions{};
    posix_spawnattr_t attributes{};
};

// Returns an errno value; 0: the child runs.
int spawn(const std::vector<std::string>& arguments, const int (&fds)[3], pid_t& pid) {
    SpawnSettings settings;
    for (int target = 0; target < 3; ++target) posix_spawn_file_actions_adddup2(&settings.actions, fds[target], target);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&settings.attributes, &none);
    posix_spawnattr_setsigdefault(&settings.attributes, &all);
    posix_spawnattr_setpgroup(&settings.attributes, 0);
    posix_spawnattr_setflags(&settings.attributes,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    return posix_spawn(&pid, argv[0], &settings.actions, &settings.attributes, argv.data(), environ);
}

} // namespace

std::string findProgram(const std::string& name) {
    const auto runnable = [](const std::string& path) {
        struct stat status {};
        return ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) && ::access(path.c_str(), X_OK) == 0;
    };
    if (name.find('/') != std::string::npos) return runnable(name) ? name : std::string();
    const char* path = std::getenv("PATH");
    const std::string folders = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
    for (size_t begin = 0; begin <= folders.size();) {
        const size_t end = std::min(folders.find(':', begin), folders.size());
        const std::string folder = folders.substr(begin, end - begin);
        const std::string candidate = (folder.empty() ? "." : folder) + "/" + name;
        if (runnable(candidate)) return candidate;
        begin = end + 1;
    }
    return {};
}

Result<std::unique_ptr<EncoderProcess>> EncoderProcess::start(const std::vector<std::string>& arguments) {
    std::unique_ptr<EncoderProcess> process(new EncoderProcess);
    process->program_ = arguments.at(0);
    // A socket instead of a pipe, because only a socket write can suppress SIGPIPE.
    int ends[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return Error{fmt::format("cannot start {}: {}", arguments[0], std::strerror(errno))};
    process->inputFd_ = ends[0];
    ::setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &kInputBufferBytes, sizeof kInputBufferBytes);
    process->outputFd_ = ::memfd_create("mural-encoder-output", MFD_CLOEXEC);
    process->errorFd_ = ::memfd_create("mural-encoder-errors", MFD_CLOEXEC);
    int failure = process->outputFd_ < 0 || process->errorFd_ < 0 ? errno : 0;
    if (failure == 0) {
        failure = spawn(arguments, {ends[1], process->outputFd_, process->errorFd_}, process->pid_);
        if (failure != 0) process->pid_ = -1;
    }
    ::close(ends[1]);
    if (failure != 0) return Error{fmt::format("cannot start {}: {}", arguments[0], std::strerror(failure))};
    process->pidFd_ = static_cast<int>(::syscall(SYS_pidfd_open, process->pid_, 0));
    if (process->pidFd_ >= 0) ::fcntl(process->pidFd_, F_SETFD, FD_CLOEXEC);
    return process;
}

EncoderProcess::~EncoderProcess() {
    kill();
    closeFd(inputFd_);
    closeFd(pidFd_);
    closeFd(outputFd_);
    closeFd(errorFd_);
}

Result<void> EncoderProcess::write(std::span<const std::byte> bytes, Deadline deadline) {
    while (!bytes.empty()) {
        if (inputFd_ < 0 || ended(0)) return howItEnded();
        const ssize_t sent = ::send(inputFd_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent > 0) {
            bytes = bytes.subspan(static_cast<size_t>(sent));
            continue;
        }
        if (errno == EINTR) continue;
        if (errno != EAGAIN && errno != EWOULDBLOCK) {
            // The child has closed its input: it is ending.
            (void)ended(deadline.leftNs(kNsPerS));
            return howItEnded();
        }
        if (deadline.passed()) return Error{fmt::format("{} does not read more data", program_)};
        pollfd ready{inputFd_, POLLOUT, 0};
        ::poll(&ready, 1, pollMs(deadline.leftNs(kNsPerS)));
    }
    return {};
}

Result<void> EncoderProcess::finish(Deadline deadline) {
    closeFd(inputFd_);
    while (!ended(deadline.leftNs(kNsPerS))) {
        if (!deadline.passed()) continue;
        kill();
        return Error{fmt::format("{} did not end in time and was stopped; its file may be "
                                 "incomplete",
                                 program_)};
    }
    if (WIFEXITED(status_) && WEXITSTATUS(status_) == 0) return {};
    return howItEnded();
}

std::string EncoderProcess::output() const { return textOf(outputFd_); }

// Waits about waitNs at most for the child's end.
bool EncoderProcess::ended(int64_t waitNs) {
    const int64_t untilNs = monotonicNowNs() + waitNs;
    while (pid_ >= 0) {
        const pid_t reaped = ::waitpid(pid_, &status_, WNOHANG);
        if (reaped != 0 && !(reaped < 0 && errno == EINTR)) {
            if (reaped < 0) status_ = kUnknownStatus; // reaped elsewhere
            pid_ = -1;
            break;
        }
        const int64_t leftNs = untilNs - monotonicNowNs();
        if (leftNs <= 0) return false;
        pollfd ready{pidFd_, POLLIN, 0}; // a negative descriptor turns poll into a sleep
        ::poll(&ready, 1, pollMs(pidFd_ >= 0 ? leftNs : std::min(leftNs, kWaitSliceNs)));
    }
    return true;
}

Error EncoderProcess::howItEnded() {
    if (pid_ >= 0) return {fmt::format("{} closed its input", program_)};
    std::string how = "ended";
    if (WIFSIGNALED(status_))
        how = fmt::format("was killed by signal {}", WTERMSIG(status_));
    else if (WIFEXITED(status_))
        how = fmt::format("ended with exit code {}", WEXITSTATUS(status_));
    const std::string last = lastLines(textOf(errorFd_));
    return {fmt::format("{} {}{}{}", program_, how, last.empty() ? "" : ": ", last)};
}

void EncoderProcess::kill() {
    closeFd(inputFd_);
    if (pid_ < 0 || ended(0)) return;
    ::kill(pid_, SIGTERM);
    if (ended(kTermGraceMs * kNsPerMs)) return;
    ::kill(pid_, SIGKILL);
    (void)ended(kTermGraceMs * kNsPerMs); // a process in an uninterruptible wait is left to init
}

} // namespace mural
