// Waits for a socket with a deadline.
#pragma once

#include <algorithm>
#include <cerrno>
#include <poll.h>

#include "common/base/clock.hpp"

namespace mural {

// Returns the events (POLLHUP and POLLERR unrequested), 0 after the deadline.
inline short waitForSocket(int fd, short events, Deadline deadline) {
    while (true) {
        pollfd poller{fd, events, 0};
        const int64_t leftNs = deadline.leftNs(3600 * kNsPerS);
        const int timeoutMs = static_cast<int>((leftNs + kNsPerMs - 1) / kNsPerMs);
        const int ready = poll(&poller, 1, timeoutMs);
        if (ready > 0) return poller.revents;
        if (ready < 0 && errno != EINTR && errno != EAGAIN) return POLLERR;
        if (deadline.passed()) return 0;
    }
}

} // namespace mural
