// The duration of a wait for another process, without the time during which either of the two processes was stopped. A
// signal, a debugger or a frozen cgroup stops a process. A limit on such a duration never ends a process that was
// merely stopped.
#pragma once

#include <cstdint>

#include "common/base/clock.hpp"

namespace mural {

class RunningTime {
public:
    // A longer gap between two calls of countNs() counts as this much, because the caller did not run in between.
    static constexpr int64_t kMaxGapNs = kNsPerS;

    // beat: a counter that the other process increments while it runs. For use by one thread.
    explicit RunningTime(int64_t nowNs, uint32_t beat = 0) : countedAtNs_(nowNs), beat_(beat) {}

    // Returns the time so far in ns. The gap since the last call counts only if the beat has changed.
    int64_t countNs(int64_t nowNs, uint32_t beat) {
        if (beat == beat_) return countedNs_;
        const int64_t gapNs = nowNs - countedAtNs_;
        countedNs_ += gapNs < kMaxGapNs ? gapNs : kMaxGapNs;
        countedAtNs_ = nowNs;
        beat_ = beat;
        return countedNs_;
    }

    // The same without another process: every call is a beat.
    int64_t countNs(int64_t nowNs) { return countNs(nowNs, beat_ + 1); }

private:
    int64_t countedNs_ = 0;
    int64_t countedAtNs_;
    uint32_t beat_;
};

} // namespace mural
