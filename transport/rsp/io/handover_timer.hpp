// Timer after which the group's thread takes over polling, because no waiting thread has returned. A former leader
// postpones it from its own thread: an occasional system call while the group's thread sleeps. A timer of the group's
// own thread would wake it each time without need.
//
// All methods require the group's lock.
#pragma once

#include <cstdint>

#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::rsp {

class HandoverTimer {
public:
    static Result<HandoverTimer> open();

    // Readable after expiry.
    [[nodiscard]] int descriptor() const { return timer_.get(); }
    // Sets the expiry between half of `afterNs` from now and all of it. Replaces the previous setting.
    void push(int64_t nowNs, int64_t afterNs);
    // A leader sleeps until `untilNs`: the timer does not expire earlier.
    void postpone(int64_t untilNs, int64_t afterNs);
    // Returns true after expiry. The timer may have been postponed since the descriptor became readable.
    bool rang(int64_t nowNs);

private:
    HandoverTimer() = default;
    void set(int64_t atNs);

    FileDescriptor timer_;
    int64_t atNs_ = INT64_MIN; // not set
};

} // namespace mural::rsp
