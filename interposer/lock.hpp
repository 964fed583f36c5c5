// A lock on one word that sleeps by futex: std::mutex would pull in more than libc promises to a
// preloaded library, and must not run destructors.
#pragma once

#include <atomic>

#include "common/futex.hpp"

namespace mural {

class Lock {
public:
    void lock() {
        uint32_t free = 0;
        if (word_.compare_exchange_strong(free, 1, std::memory_order_acquire)) return;
        for (int spin = 0; spin < 100; ++spin) {
            free = 0;
            if (word_.compare_exchange_weak(free, 1, std::memory_order_acquire)) return;
        }
        while (word_.exchange(2, std::memory_order_acquire) != 0) futexWait(word_, 2, 100'000'000);
    }
    bool tryLock() {
        uint32_t free = 0;
        return word_.compare_exchange_strong(free, 1, std::memory_order_acquire);
    }
    void unlock() {
        if (word_.exchange(0, std::memory_order_release) == 2) futexWakeAll(word_);
    }

private:
    std::atomic<uint32_t> word_{0};
};

class Guard {
public:
    explicit Guard(Lock& lock) : lock_(lock) { lock_.lock(); }
    ~Guard() { lock_.unlock(); }
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;

private:
    Lock& lock_;
};

} // namespace mural
