#include "nodes/launch/private_display.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>
#include <xcb/xcb.h>

#include "common/log/log.hpp"
#include "nodes/launch/display_numbers.hpp"
#include "nodes/launch/program_check.hpp"

namespace mural::launch {

namespace {

constexpr int64_t kStartMs = 20'000;
constexpr int64_t kEndMs = 3'000;
constexpr int64_t kProbeMs = 5'000;
constexpr int kAttempts = 8;

class OwnedFd {
public:
    explicit OwnedFd(int fd) : fd_(fd) {}
    OwnedFd(const OwnedFd&) = delete;
    OwnedFd& operator=(const OwnedFd&) = delete;
    ~OwnedFd() { reset(); }
    void reset() {
        if (fd_ >= 0) close(std::exchange(fd_, -1));
    }
    [[nodiscard]] int get() const { return fd_; }

private:
    int fd_;
};

// Reads the number that Xvfb writes to its -displayfd once it listens. Empty: it has ended or timed out.
std::string readDisplayNumber(int fd, ChildProcess& server) {
    const Deadline deadline = Deadline::inMs(kStartMs);
    std::string text;
    while (!deadline.passed()) {
        pollfd waiting{fd, POLLIN, 0};
        if (poll(&waiting, 1, 50) > 0) {
            char part[16];
            const ssize_t n = read(fd, part, sizeof part);
            if (n <= 0) return {};
            text.append(part, static_cast<size_t>(n));
            if (text.back() == '\n') return text.substr(0, text.size() - 1);
        } else if (!server.running()) {
            return {};
        }
    }
    return {};
}

// The last line of the server's log.
std::string lastLine(int logFd) {
    std::string text(4096, '\0');
    const off_t size = lseek(logFd, 0, SEEK_END);
    const off_t from = size > 4096 ? size - 4096 : 0;
    const ssize_t n = pread(logFd, text.data(), text.size(), from);
    text.resize(n > 0 ? static_cast<size_t>(n) : 0);
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    const auto at = text.rfind('\n');
    return at == std::string::npos ? text : text.substr(at + 1);
}

struct ServerStart {
    std::string binary;
    std::string name; // ":99"
    int width = 0;
    int height = 0;
    std::string authority;
    int logFd = -1;
};

SpawnRequest serverRequest(const ServerStart& start, int numberFd) {
    SpawnRequest request;
    request.file = start.binary;
    request.arguments = {"Xvfb",
                         start.name,
                         "-displayfd",
                         std::to_string(numberFd),
                         "-screen",
                         "0",
                         std::to_string(start.width) + "x" + std::to_string(start.height) + "x24",
                         "-nolisten",
                         "tcp",
                         "-noreset",
                         "-auth",
                         start.authority,
                         "+extension",
                         "GLX",
                         "+extension",
                         "RANDR",
                         "-s",
                         "0"};
    Environment environment = Environment::current();
    removeCapture(environment);
    request.environment = environment.entries();
    request.inheritedFds = {numberFd};
    request.outputFd = start.logFd;
    request.errorFd = start.logFd;
    request.ownSession = true; // Ctrl-C is for the program
    request.signalWhenWeDie = SIGTERM;
    return request;
}

// Returns whether the server accepts connections. false: it has ended or timed out. Error: it can't be started.
Result<bool> startServer(const ServerStart& start, ChildProcess& server) {
    int number[2];
    if (pipe2(number, O_CLOEXEC) != 0)
        return Error{"cannot create a pipe for Xvfb: " + std::string(std::strerror(errno))};
    const OwnedFd readEnd(number[0]);
    OwnedFd writeEnd(number[1]);
    auto started = ChildProcess::start(serverRequest(start, writeEnd.get()));
    if (!started) return started.error();
    server = started.value();
    writeEnd.reset();
    return !readDisplayNumber(readEnd.get(), server).empty();
}

} // namespace

Result<std::unique_ptr<PrivateDisplay>> PrivateDisplay::start(int width, int height) {
    const ProgramCheck binary = findProgram("Xvfb", Environment::current().get("PATH").value_or("/usr/bin:/bin"));
    if (!binary.ok()) {
        return Error{"--size and missing displays require Xvfb, which was not found; install Debian's package xvfb"};
    }
    auto authority = XAuthority::create();
    if (!authority) return authority.error();
    const OwnedFd log(memfd_create("mural-xvfb-log", MFD_CLOEXEC));

    std::unique_ptr<PrivateDisplay> display(new PrivateDisplay);
    display->authority_ = std::move(authority.value());
    const DisplayNumbers numbers;
    // Another attempt helps if a server that is not Mural's has taken the number meanwhile.
    int first = 0;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        const auto number = numbers.firstFree(first);
        if (!number) return Error{"all numbers of X displays are in use; remove unused files in /tmp/.X11-unix"};
        display->name_ = ":" + std::to_string(*number);
        const auto ready = startServer(
            {binary.path, display->name_, width, height, display->authority_->path(), log.get()}, display->server_);
        if (!ready) return ready.error();
        if (*ready) {
            log::debug(log::Topic::Launch, "private display ", display->name_, " of ", width, "x", height, " pixels");
            return display;
        }
        display->server_.end(Deadline::inMs(kEndMs));
        if (numbers.firstFree(*number) != number)
            first = *number + 1;
        else if (attempt > 0)
            break; // the number is not the reason
    }
    const std::string words = lastLine(log.get());
    return Error{"Xvfb did not start a private display of " + std::to_string(width) + "x" + std::to_string(height) +
                 " pixels" + (words.empty() ? std::string() : ": " + words) + "; check free memory and /tmp/.X11-unix"};
}

PrivateDisplay::~PrivateDisplay() {
    if (server_.started()) server_.end(Deadline::inMs(kEndMs));
}

void PrivateDisplay::use(Environment& environment) const {
    environment.set("DISPLAY", name_);
    environment.set("XAUTHORITY", authority_->path());
    environment.unset("WAYLAND_DISPLAY"); // toolkits prefer Wayland if available
    environment.unset("WAYLAND_SOCKET");
    if (environment.get("XDG_SESSION_TYPE")) environment.set("XDG_SESSION_TYPE", "x11");
}

bool displayUsable(const std::string& name) {
    if (name.empty()) return false;
    const pid_t pid = fork();
    if (pid == 0) {
        alarm(kProbeMs / 1000); // ends this child if the server does not answer
        xcb_connection_t* connection = xcb_connect(name.c_str(), nullptr);
        _exit(xcb_connection_has_error(connection) == 0 ? 0 : 1);
    }
    if (pid < 0) return false;
    ChildProcess probe = ChildProcess::adopt(pid);
    if (!probe.waitUntil(Deadline::inMs(kProbeMs + 1000))) {
        probe.end(Deadline::inMs(0));
        return false;
    }
    return probe.exitStatus() == 0;
}

} // namespace mural::launch
