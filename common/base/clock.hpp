// Monotonic time in nanoseconds, and deadlines. Every wait in Mural has a deadline.
#pragma once

#include <cerrno>
#include <cstdint>
#include <ctime>
#include <sys/syscall.h>
#include <unistd.h>

#include "common/base/pauses.hpp"

namespace mural {

constexpr int64_t kNsPerMs = 1'000'000;
constexpr int64_t kNsPerS = 1'000'000'000;

// Uses the raw system call, because captured programs may replace clock_gettime (virtual clocks).
inline int64_t monotonicNowNs() {
    timespec t{};
    syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &t);
    return static_cast<int64_t>(t.tv_sec) * kNsPerS + t.tv_nsec;
}

// Sleeps until a time of monotonicNowNs(). Returns immediately if it has passed.
inline void sleepUntilNs(int64_t atNs) {
    const timespec until{static_cast<time_t>(atNs / kNsPerS), static_cast<long>(atNs % kNsPerS)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {}
}

// Returns the CPU time of the calling thread.
inline int64_t threadCpuNowNs() {
    timespec t{};
    syscall(SYS_clock_gettime, CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<int64_t>(t.tv_sec) * kNsPerS + t.tv_nsec;
}

// Counts only while this process runs (common/base/pauses.hpp).
class Deadline {
public:
    static Deadline inMs(int64_t ms) { return Deadline(runningNowNs() + ms * kNsPerMs); }
    static Deadline never() { return Deadline(INT64_MAX); }
    // Converts from a time of monotonicNowNs(), and back as of now. INT64_MAX: never.
    static Deadline at(int64_t ns) { return Deadline(ns == INT64_MAX ? ns : ns - pauses::totalNs(monotonicNowNs())); }
    [[nodiscard]] int64_t atNs() const {
        return atNs_ == INT64_MAX ? atNs_ : atNs_ + pauses::totalNs(monotonicNowNs());
    }

    [[nodiscard]] bool passed() const { return atNs_ != INT64_MAX && runningNowNs() >= atNs_; }
    // Returns the remaining time in ns, 0 after the deadline, capped for callers that wait in slices.
    [[nodiscard]] int64_t leftNs(int64_t capNs = INT64_MAX) const {
        if (atNs_ == INT64_MAX) return capNs;
        const int64_t left = atNs_ - runningNowNs();
        return left < 0 ? 0 : (left < capNs ? left : capNs);
    }

private:
    explicit Deadline(int64_t atNs) : atNs_(atNs) {}

    // Returns monotonicNowNs() without the pauses.
    static int64_t runningNowNs() {
        const int64_t nowNs = monotonicNowNs();
        return nowNs - pauses::totalNs(nowNs);
    }

    int64_t atNs_; // of runningNowNs()
};

} // namespace mural
