// All that a group waits for outside, as one descriptor: datagrams at its sockets, and a time. Who waits for something of
// the group sees to that, too, where nobody else does: a thread less is woken for each datagram. Who waits here knows how
// long it may; the time is for who sleeps already, and for the group's thread. Any thread may set it.
//
// Who waits is at the sockets only as long as it waits: an epoll would be told of every datagram that comes meanwhile, with
// locks and by the processor that brings it (2 to 4 % of a sender whose receivers are on its machine).
#pragma once

#include <array>
#include <cstdint>
#include <poll.h>
#include <span>

#include "common/result.hpp"
#include "transport/file_descriptor.hpp"

namespace mural::rsp {

class Arrivals {
public:
    static Result<Arrivals> open();

    // Datagrams at this socket are waited for from now on; of at most kMostSockets, and while nobody waits.
    Result<void> add(int socket);
    // Who waits, wakes at this time (of the monotonic clock) at the latest. Past ones: at once. One wakes, once.
    void wakeAt(int64_t ns);

    // The sockets at which something is, once there is something or it is time; none after the timeout. What is at a
    // socket stays there for others until it is fetched.
    std::span<const int> wait(int64_t timeoutNs);
    // What the last wait found, without looking.
    [[nodiscard]] std::span<const int> found() const { return std::span(ready_).first(found_); }

    // Readable when wait() would return at once, and this has not been turned off: for the group's thread, which need
    // not wake while another one waits.
    [[nodiscard]] int watched() const { return watched_.get(); }
    void setWatched(bool on);

private:
    static constexpr size_t kMostSockets = 2;

    Arrivals() = default;

    FileDescriptor timer_;
    FileDescriptor watched_; // epoll of all, or of nothing
    bool isWatched_ = true;
    std::array<pollfd, 1 + kMostSockets> all_{}; // the timer, then the sockets
    size_t count_ = 0;
    std::array<int, kMostSockets> ready_{};
    size_t found_ = 0; // of ready_
};

} // namespace mural::rsp
