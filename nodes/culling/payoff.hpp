// Whether attempts on one kind of draw are worth their time. After several in vain, none is made for a while.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

namespace mural::culling {

// After this number of attempts in vain, further ones pause for a number of draws, which each repetition doubles.
inline constexpr uint32_t kVainAttempts = 8, kLeastPause = 64, kLongestPause = 4096;

class Payoff {
public:
    [[nodiscard]] bool isPaused() const { return pause_ > 0; }
    // Counts a draw without an attempt.
    void skip() { pause_ -= pause_ > 0 ? 1 : 0; }
    // Counts an attempt. saved: it left something out.
    void tried(bool saved) {
        vain_ = saved ? 0 : vain_ + 1;
        if (saved) lastPause_ = 0;
        if (vain_ < kVainAttempts) return;
        vain_ = 0;
        pause_ = lastPause_ = std::clamp(2 * lastPause_, kLeastPause, kLongestPause);
    }

private:
    uint32_t vain_ = 0;      // attempts in vain, in a row
    uint32_t pause_ = 0;     // further draws without an attempt
    uint32_t lastPause_ = 0; // 0: the last attempt saved something
};

} // namespace mural::culling
