// A lock in one word, which sleeps by futex. A preloaded library may use libc only, which rules out std::mutex. The
// lock must not run destructors.
#pragma once

#include <atomic>

#include "common/ipc/futex.hpp"
#include "interposer/process/process.hpp"

namespace mural {

// The word is 0 when free. Otherwise it identifies the process that holds the lock. A parent's thread that held it at a
// fork does not exist in the child. A lock of another process therefore counts as free.
class Lock {
public:
    void lock() {
        const uint32_t mine = process::number() << 2;
        uint32_t seen = 0;
        if (word_.compare_exchange_strong(seen, mine | kHeld, std::memory_order_acquire)) return;
        for (int spin = 0; spin < 100; ++spin) {
            seen = 0;
            if (word_.compare_exchange_weak(seen, mine | kHeld, std::memory_order_acquire)) return;
        }
        while (!takeContended(mine)) futexWait(word_, mine | kAwaited, 100'000'000);
    }
    bool tryLock() {
        const uint32_t mine = process::number() << 2;
        uint32_t seen = word_.load(std::memory_order_relaxed);
        return !isHeld(seen, mine) && word_.compare_exchange_strong(seen, mine | kHeld, std::memory_order_acquire);
    }
    void unlock() {
        if (word_.exchange(0, std::memory_order_release) & kAwaited) futexWakeAll(word_);
    }

private:
    static constexpr uint32_t kHeld = 1, kAwaited = 2, kStateBits = 3;

    static bool isHeld(uint32_t word, uint32_t mine) { return word != 0 && (word & ~kStateBits) == mine; }

    // Returns false if another thread of this process holds the lock. The word then has kAwaited set.
    bool takeContended(uint32_t mine) {
        uint32_t seen = word_.load(std::memory_order_relaxed);
        for (;;) {
            const bool held = isHeld(seen, mine);
            if (held && (seen & kAwaited)) return false;
            if (word_.compare_exchange_weak(seen, mine | kAwaited, std::memory_order_acquire)) {
                if (!held) return true;
                return false;
            }
        }
    }

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
