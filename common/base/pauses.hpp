// Measures how long this process was stopped as a whole: by a signal, a debugger or a frozen cgroup. Deadlines do not
// count that time: while it is stopped, the process cannot receive what others send, so their silence is no failure.
//
// PauseWatch (common/base/pause_watch.hpp) calls tick(). Without a PauseWatch no pause is known. Any thread may call
// totalNs().
#pragma once

#include <atomic>
#include <cstdint>

namespace mural::pauses {

constexpr int64_t kTickNs = 250'000'000;
constexpr int64_t kMinPauseNs = 1'000'000'000; // shorter gaps between two ticks are scheduling delays

inline std::atomic<uint32_t> sequence{0};  // odd while the next two words change
inline std::atomic<int64_t> lastTickNs{0}; // time of monotonicNowNs(); 0: no watch
inline std::atomic<int64_t> finishedNs{0}; // sum of the pauses that ended before the last tick

// One thread calls it every kTickNs.
inline void tick(int64_t nowNs) {
    const int64_t lastNs = lastTickNs.load(std::memory_order_relaxed);
    const int64_t gapNs = lastNs == 0 ? 0 : nowNs - lastNs;
    sequence.fetch_add(1, std::memory_order_acq_rel);
    if (gapNs > kMinPauseNs)
        finishedNs.store(finishedNs.load(std::memory_order_relaxed) + gapNs - kTickNs, std::memory_order_relaxed);
    lastTickNs.store(nowNs, std::memory_order_relaxed);
    sequence.fetch_add(1, std::memory_order_release);
}

inline void endWatch() {
    sequence.fetch_add(1, std::memory_order_acq_rel);
    lastTickNs.store(0, std::memory_order_relaxed);
    sequence.fetch_add(1, std::memory_order_release);
}

// Returns the sum of all pauses until now. Includes the latest pause even if the calling thread resumes before the
// watch thread.
inline int64_t totalNs(int64_t nowNs) {
    while (true) {
        const uint32_t before = sequence.load(std::memory_order_acquire);
        const int64_t lastNs = lastTickNs.load(std::memory_order_relaxed);
        const int64_t total = finishedNs.load(std::memory_order_relaxed);
        std::atomic_thread_fence(std::memory_order_acquire);
        if (before % 2 != 0 || sequence.load(std::memory_order_relaxed) != before) continue;
        const int64_t gapNs = lastNs == 0 ? 0 : nowNs - lastNs;
        return gapNs > kMinPauseNs ? total + gapNs - kTickNs : total;
    }
}

} // namespace mural::pauses
