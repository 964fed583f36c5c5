// Measures the time differences between members of a barrier that show the same frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "nodes/swap_barrier/swap_key.hpp"

namespace mural {

struct SkewNumbers {
    int64_t swaps = 0;               // shown by at least two members
    int64_t medianNs = 0, p99Ns = 0; // over the last 4096 swaps
    int64_t maxNs = 0;
};

class SkewMeter {
public:
    void released(const SwapKey& key, size_t windows);
    // All times must be from the same clock.
    void shown(const SwapKey& key, int64_t atNs);
    [[nodiscard]] SkewNumbers numbers() const;

private:
    struct Open {
        SwapKey key;
        size_t awaited = 0;
        int64_t firstNs = 0, lastNs = 0;
        bool any = false;
    };
    std::deque<Open> open_; // bounded: windows that never report are dropped
    std::vector<int64_t> last_;
    size_t next_ = 0;
    int64_t swaps_ = 0, maxNs_ = 0;
};

} // namespace mural
