// Sleeps on, and wakes waiters of, a 32-bit word in memory that processes share (Linux futex).
#pragma once

#include <atomic>
#include <cstdint>
#include <ctime>
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace mural {

// Sleeps while word == expected, for at most timeoutNs. Spurious returns are possible.
inline void futexWait(const std::atomic<uint32_t>& word, uint32_t expected, int64_t timeoutNs) {
    timespec t{};
    t.tv_sec = timeoutNs / 1'000'000'000;
    t.tv_nsec = timeoutNs % 1'000'000'000;
    syscall(SYS_futex, &word, FUTEX_WAIT, expected, &t, nullptr, 0);
}

inline void futexWakeAll(const std::atomic<uint32_t>& word) {
    syscall(SYS_futex, &word, FUTEX_WAKE, INT32_MAX, nullptr, nullptr, 0);
}

} // namespace mural
