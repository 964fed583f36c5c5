#include "tools/mural/head_control.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace mural::cli {

namespace {

constexpr int kSendMs = 5'000;
constexpr int64_t kEndMs = 3'000;
constexpr size_t kMaxLineBytes = size_t{1} << 20;

} // namespace

Result<std::unique_ptr<HeadControl>> HeadControl::start(const std::vector<std::string>& command,
                                                        const launch::Environment& environment) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        return Error{"cannot create a socket for the head: " + std::string(std::strerror(errno))};
    }
    launch::SpawnRequest request;
    request.file = command.front();
    request.arguments = command;
    request.arguments.insert(request.arguments.end(), {"--control-fd", std::to_string(ends[1])});
    request.environment = environment.entries();
    request.inheritedFds = {ends[1]};
    request.outputFd = STDERR_FILENO; // standard output belongs to the program
    request.ownSession = true;        // Ctrl-C reaches the program only; the head ends after it, in order
    auto process = launch::ChildProcess::start(request);
    close(ends[1]);
    if (!process) {
        close(ends[0]);
        return process.error();
    }
    return std::unique_ptr<HeadControl>(new HeadControl(ends[0], process.value()));
}

HeadControl::~HeadControl() {
    close(fd_); // tells the head to finish
    if (!process_.waitUntil(Deadline::inMs(kEndMs))) process_.end(Deadline::inMs(kEndMs));
    process_.signalGroup(SIGKILL); // ends nodes that a killed head left behind
}

void HeadControl::send(const std::string& line) {
    const std::string bytes = line + "\n";
    size_t done = 0;
    const Deadline deadline = Deadline::inMs(kSendMs);
    while (connected_ && done < bytes.size()) {
        const ssize_t n = ::send(fd_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n > 0) {
            done += static_cast<size_t>(n);
        } else if (n < 0 && (errno == EAGAIN || errno == EINTR) && !deadline.passed()) {
            pollfd room{fd_, POLLOUT, 0};
            poll(&room, 1, 50);
        } else {
            connected_ = false;
        }
    }
}

std::vector<std::string> HeadControl::receive() {
    std::vector<std::string> lines;
    char part[8192];
    while (connected_) {
        const ssize_t n = recv(fd_, part, sizeof part, MSG_DONTWAIT);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && errno == EAGAIN) break;
        if (n <= 0 || partial_.size() > kMaxLineBytes) {
            connected_ = false;
            break;
        }
        partial_.append(part, static_cast<size_t>(n));
    }
    size_t at = 0;
    for (size_t end = 0; (end = partial_.find('\n', at)) != std::string::npos; at = end + 1) {
        lines.push_back(partial_.substr(at, end - at));
    }
    partial_.erase(0, at);
    return lines;
}

} // namespace mural::cli
