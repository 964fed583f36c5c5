#include "nodes/head/session/control_channel.hpp"

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/socket.h>

#include "common/json/json_text.hpp"

namespace mural {
namespace {

// `mural run` may be stopped (Ctrl-Z). Its lines are buffered so that no thread of the head blocks.
constexpr size_t kMaxUnsentBytes = size_t{1} << 20;
constexpr int64_t kLastLinesMs = 5000;
constexpr size_t kMaxLineBytes = size_t{4} << 20;

int pollMs(Deadline deadline) { return static_cast<int>((deadline.leftNs(kNsPerS) + kNsPerMs - 1) / kNsPerMs); }

} // namespace

void ControlChannel::send(const nlohmann::json& event) {
    // Text from nodes and programs may not be valid UTF-8.
    writeLine(jsonText(event) + "\n");
}

void ControlChannel::say(const std::string& text) { send({{"event", "say"}, {"text", text}}); }

void ControlChannel::error(const std::string& text) { send({{"event", "error"}, {"text", text}}); }

void ControlChannel::writeLine(const std::string& line) {
    const std::lock_guard lock(mutex_);
    if (unsent_.size() > kMaxUnsentBytes) return; // the reader has been stopped for long
    unsent_ += line;
    writeSome();
}

// Writes as much as the socket accepts.
void ControlChannel::writeSome() {
    while (!broken_ && !unsent_.empty()) {
        const ssize_t n = ::send(fd_.get(), unsent_.data(), unsent_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n > 0) unsent_.erase(0, static_cast<size_t>(n));
        if (n >= 0 || errno == EINTR) continue;
        broken_ = errno != EAGAIN && errno != EWOULDBLOCK;
        return;
    }
}

ControlChannel::~ControlChannel() {
    const Deadline deadline = Deadline::inMs(kLastLinesMs);
    const std::lock_guard lock(mutex_);
    while (!broken_ && !unsent_.empty() && !deadline.passed()) {
        pollfd room{fd_.get(), POLLOUT, 0};
        poll(&room, 1, pollMs(deadline));
        writeSome();
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

// Returns false if no data is available now.
bool ControlChannel::fill(Deadline deadline) {
    pollfd data{fd_.get(), POLLIN, 0};
    {
        const std::lock_guard lock(mutex_);
        if (!unsent_.empty()) data.events |= POLLOUT;
    }
    const int ready = poll(&data, 1, pollMs(deadline));
    if (ready < 0) return false; // interrupted by a signal: the caller checks its flag
    if (ready == 0) return !deadline.passed();
    if ((data.revents & POLLOUT) != 0) {
        const std::lock_guard lock(mutex_);
        writeSome();
    }
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
    pollfd poller{fd_.get(), 0, 0};
    const bool hungUp = poll(&poller, 1, 0) > 0 && (poller.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
    return hungUp || markedBroken();
}

} // namespace mural
