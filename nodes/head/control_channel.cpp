#include "nodes/head/control_channel.hpp"

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/socket.h>

namespace mural {
namespace {

// `mural run` reads all the time; when it does not take a line for this long it is as good as gone.
constexpr int64_t kWritePatienceMs = 2000;
constexpr size_t kMaxLineBytes = size_t{4} << 20;

int pollMs(Deadline deadline) {
    return static_cast<int>((deadline.leftNs(kNsPerS) + kNsPerMs - 1) / kNsPerMs);
}

} // namespace

void ControlChannel::send(const nlohmann::json& event) {
    // Text from nodes and programs need not be UTF-8.
    writeLine(event.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void ControlChannel::say(const std::string& text) { send({{"event", "say"}, {"text", text}}); }

void ControlChannel::error(const std::string& text) { send({{"event", "error"}, {"text", text}}); }

void ControlChannel::writeLine(const std::string& line) {
    const std::lock_guard lock(mutex_);
    const Deadline deadline = Deadline::inMs(kWritePatienceMs);
    size_t done = 0;
    while (!broken_ && done < line.size()) {
        const ssize_t n = ::send(fd_.get(), line.data() + done, line.size() - done,
                                 MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n >= 0) {
            done += static_cast<size_t>(n);
            continue;
        }
        if (errno == EINTR) continue;
        const bool full = errno == EAGAIN || errno == EWOULDBLOCK;
        if (!full || deadline.passed()) {
            broken_ = true;
            return;
        }
        pollfd room{fd_.get(), POLLOUT, 0};
        poll(&room, 1, pollMs(deadline));
    }
}

std::optional<std::string> ControlChannel::receive(Deadline deadline) {
    while (true) {
        const size_t end = received_.find('\n');
        if (end != std::string::npos) {
            std::string line = received_.substr(0, end);
            received_.erase(0, end + 1);
            return line;
        }
        if (markedBroken() || received_.size() > kMaxLineBytes || !fill(deadline)) return std::nullopt;
    }
}

// False when nothing more can be had now.
bool ControlChannel::fill(Deadline deadline) {
    pollfd data{fd_.get(), POLLIN, 0};
    const int ready = poll(&data, 1, pollMs(deadline));
    if (ready < 0) return false; // a signal: the caller looks at its flag
    if (ready == 0) return !deadline.passed();
    char bytes[4096];
    const ssize_t n = recv(fd_.get(), bytes, sizeof(bytes), MSG_DONTWAIT);
    if (n > 0) {
        received_.append(bytes, static_cast<size_t>(n));
        return true;
    }
    if (n < 0 && (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK)) return true;
    markBroken();
    return false;
}

void ControlChannel::markBroken() {
    const std::lock_guard lock(mutex_);
    broken_ = true;
}

bool ControlChannel::markedBroken() const {
    const std::lock_guard lock(mutex_);
    return broken_;
}

bool ControlChannel::broken() const {
    pollfd look{fd_.get(), 0, 0};
    const bool hungUp = poll(&look, 1, 0) > 0 && (look.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
    return hungUp || markedBroken();
}

} // namespace mural
