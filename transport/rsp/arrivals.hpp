// All that a group waits for outside, as one descriptor: datagrams at its sockets, and a time. Who waits for something of
// the group sees to that, too, where nobody else does: a thread less is woken for each datagram. Who waits here knows how
// long it may; the time is for who sleeps already, and for the group's thread. Any thread may set it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <sys/epoll.h>

#include "common/result.hpp"
#include "transport/file_descriptor.hpp"

namespace mural::rsp {

class Arrivals {
public:
    static Result<Arrivals> open();

    // Datagrams at this socket are waited for from now on.
    Result<void> add(int socket);
    // Who waits, wakes at this time (of the monotonic clock) at the latest. Past ones: at once. One wakes, once.
    void wakeAt(int64_t ns);

    // The sockets at which something is, once there is something or it is time; none after the timeout. What is at a
    // socket stays there for others until it is fetched.
    std::span<const int> wait(int64_t timeoutNs);

    // Readable when wait() would return at once, and this has not been turned off: for the group's thread, which need
    // not wake while another one waits.
    [[nodiscard]] int watched() const { return watched_.get(); }
    void setWatched(bool on);

private:
    Arrivals() = default;
    int waitFor(std::span<epoll_event> events, int64_t timeoutNs);

    FileDescriptor all_;     // epoll of sockets and timer
    FileDescriptor timer_;
    FileDescriptor watched_; // epoll of all_ alone, which can be turned off by one call
    std::array<int, 4> ready_{};
    bool fineTimeouts_ = true; // the kernel knows epoll_pwait2
};

} // namespace mural::rsp
