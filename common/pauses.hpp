// How long this process was stopped as a whole: by a signal, a debugger or a frozen cgroup. Deadlines do not count that
// time: what other processes did not do meanwhile, or did and could not be seen, is no failure of theirs.
//
// PauseWatch (common/pause_watch.hpp) measures it; without one no pause is known. Any thread.
#pragma once

#include <atomic>
#include <cstdint>

namespace mural::pauses {

constexpr int64_t kTickNs = 250'000'000;
constexpr int64_t kMinPauseNs = 1'000'000'000; // a shorter gap between two ticks is the scheduler's

inline std::atomic<uint32_t> sequence{0}; // odd while the other two change
inline std::atomic<int64_t> lastTickNs{0}; // of monotonicNowNs(); 0: nobody watches
inline std::atomic<int64_t> finishedNs{0}; // all pauses that ended before the last tick

// By one thread, every kTickNs.
inline void tick(int64_t nowNs) {
    const int64_t lastNs = lastTickNs.load(std::memory_order_relaxed);
    const int64_t gapNs = lastNs == 0 ? 0 : nowNs - lastNs;
    sequence.fetch_add(1, std::memory_order_acq_rel);
    if (gapNs > kMinPauseNs) finishedNs.store(finishedNs.load(std::memory_order_relaxed) + gapNs - kTickNs, std::memory_order_relaxed);
    lastTickNs.store(nowNs, std::memory_order_relaxed);
    sequence.fetch_add(1, std::memory_order_release);
}

inline void endWatch() {
    sequence.fetch_add(1, std::memory_order_acq_rel);
    lastTickNs.store(0, std::memory_order_relaxed);
    sequence.fetch_add(1, std::memory_order_release);
}

// All pauses until now. A thread that runs again before the watch does sees the latest pause, too.
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
