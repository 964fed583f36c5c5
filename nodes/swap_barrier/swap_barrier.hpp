// A node's part in a swap barrier: the leader (rank 0) lets all go, the others follow it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "nodes/swap_barrier/skew_meter.hpp"
#include "nodes/swap_barrier/swap_key.hpp"

namespace mural {

struct SwapBarrierNumbers {
    SkewNumbers skew;
    int64_t clockErrorNs = 0; // what the times of the worst known clock may be off by
};

class SwapBarrier {
public:
    using Log = std::function<void(const std::string&)>; // one line for the user; from any thread

    // A member that has not come for that long is not waited for.
    static constexpr int64_t kPatienceMs = 5000;

    SwapBarrier() = default;
    SwapBarrier(const SwapBarrier&) = delete;
    SwapBarrier& operator=(const SwapBarrier&) = delete;
    virtual ~SwapBarrier() = default;

    // The picture of `key` is drawn. Returns when all have said so, or no one waits any more: the time of monotonicNowNs() at
    // which to show it. By the thread that replays.
    virtual int64_t await(const SwapKey& key) = 0;
    virtual void shown(const SwapKey& key, int64_t atNs) = 0;
    // The leader's only.
    [[nodiscard]] virtual std::optional<SwapBarrierNumbers> numbers() const { return std::nullopt; }
};

} // namespace mural
