// Estimates the offset of a node's clock while the statistics of frames are on. Pure; not thread-safe.
//
// Round trips (ClockOffset) are exact only while the node waits for packets: a node that draws reads a probe late. The
// shortest round trip therefore counts, even if it is old. The way from the node to the head is short at any time. A
// change of its shortest duration shows how far the clocks have drifted since.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "nodes/swap_barrier/clock_offset.hpp"

namespace mural {

class NodeClock {
public:
    // For a node on the head's machine: both have the same clock.
    static NodeClock shared();
    static NodeClock ofNode(bool isOnHeadsMachine) { return isOnHeadsMachine ? shared() : NodeClock(); }

    void addRoundTrip(const ClockSample& sample);
    // A message that left the node at leftThereNs (its clock) and arrived at arrivedNs (the head's).
    void addMessage(int64_t leftThereNs, int64_t arrivedNs);

    // Node's clock minus the head's.
    [[nodiscard]] int64_t offsetNs() const { return offsetNs_ + driftNs(); }
    // Upper bound of the error at the time of the best round trip. INT64_MAX: unknown.
    [[nodiscard]] int64_t errorNs() const { return errorNs_; }
    [[nodiscard]] bool isKnown() const { return errorNs_ != INT64_MAX; }

private:
    [[nodiscard]] int64_t driftNs() const;

    static constexpr size_t kMessages = 64;
    bool isShared_ = false;
    int64_t offsetNs_ = 0;
    int64_t errorNs_ = INT64_MAX;
    int64_t baseNs_ = INT64_MAX; // shortest way of a message, by both clocks, at that time
    std::array<int64_t, kMessages> waysNs_{};
    size_t messages_ = 0; // since then
};

} // namespace mural
