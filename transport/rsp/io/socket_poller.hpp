// Polls the sockets and the timer of a group through one descriptor. A thread that waits for data of the group polls
// for all, which saves waking another thread per datagram. The waiting thread knows its own timeout; the timer serves
// threads that already sleep, and the group's thread. Any thread may set the timer.
//
// Waiting uses poll, not epoll. The kernel would notify an epoll descriptor of every datagram, with locks and on the
// receiving processor, even while no thread waits. That costs 2 to 4 % of a sender's time if its receivers run on the
// same machine.
#pragma once

#include <array>
#include <cstdint>
#include <poll.h>
#include <span>

#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::rsp {

class SocketPoller {
public:
    static Result<SocketPoller> open();

    // Adds a socket, at most kMaxSockets. Call before the first wait.
    Result<void> add(int socket);
    // Wakes one waiting thread at this time (monotonic clock) at the latest, once. A past time wakes immediately.
    void wakeAt(int64_t ns);

    // Returns the readable sockets, as soon as one is readable or the timer expires; none after the timeout. Does not
    // read from the sockets.
    std::span<const int> wait(int64_t timeoutNs);
    // Returns the result of the last wait without polling.
    [[nodiscard]] std::span<const int> found() const { return std::span(ready_).first(found_); }

    // Descriptor that is readable when wait() would return immediately, unless disabled. For the group's thread, which
    // sleeps while another thread waits.
    [[nodiscard]] int watched() const { return watched_.get(); }
    void setWatched(bool on);

private:
    static constexpr size_t kMaxSockets = 2;

    SocketPoller() = default;

    FileDescriptor timer_;
    FileDescriptor watched_; // epoll of all descriptors, or of none
    bool isWatched_ = true;
    std::array<pollfd, 1 + kMaxSockets> all_{}; // the timer, then the sockets
    size_t count_ = 0;
    std::array<int, kMaxSockets> ready_{};
    size_t found_ = 0; // number of valid entries of ready_
};

} // namespace mural::rsp
