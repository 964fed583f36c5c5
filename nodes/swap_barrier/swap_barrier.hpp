// A node's end of a swap barrier: the leader (rank 0) releases the members.
#pragma once

#include <cstdint>
#include <optional>

#include "nodes/swap_barrier/skew_meter.hpp"
#include "nodes/swap_barrier/swap_key.hpp"

namespace mural {

struct SwapBarrierNumbers {
    SkewNumbers skew;
    int64_t clockErrorNs = 0; // maximum error of the members' clock estimates
};

class SwapBarrier {
public:
    // A member that exceeds this delay is ignored.
    static constexpr int64_t kPatienceMs = 5000;

    SwapBarrier() = default;
    SwapBarrier(const SwapBarrier&) = delete;
    SwapBarrier& operator=(const SwapBarrier&) = delete;
    virtual ~SwapBarrier() = default;

    // Reports that the picture of `key` is drawn. Blocks until all members have reported, or the wait times out.
    // Returns the time of monotonicNowNs() at which to show the picture. Call from the replay thread.
    virtual int64_t await(const SwapKey& key) = 0;
    virtual void shown(const SwapKey& key, int64_t atNs) = 0;
    // Leader only.
    [[nodiscard]] virtual std::optional<SwapBarrierNumbers> numbers() const { return std::nullopt; }
};

} // namespace mural
