// The statistics of frames while a client requests them. Thread-safe.
//
// They are off until the first request, and again some seconds after the last one. While they are off, each hook costs
// a read of an atomic or thread-local variable.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include "nodes/head/statistics/frame_ring.hpp"
#include "nodes/head/statistics/node_clock.hpp"
#include "streamcodec/wire/frame_spans.hpp"

namespace mural {

class FrameStatistics {
public:
    static constexpr int64_t kLeaseNs = 10'000'000'000; // from a request to the end of the statistics

    // clocks: one per node.
    explicit FrameStatistics(std::vector<NodeClock> clocks) : clocks_(std::move(clocks)) {}

    [[nodiscard]] bool isOn() const { return isOn_.load(std::memory_order_relaxed); }
    // Requests statistics for the next kLeaseNs. Returns true if they were off.
    bool request(int64_t nowNs);
    // Returns true if the last request has expired, and the statistics were on.
    bool expire(int64_t nowNs);

    // These have no effect while the statistics are off. A node's spans are dropped while its clock is unknown.
    void add(uint32_t client, uint32_t frame, SpanTrack track, int64_t nowNs);
    void addNode(int node, const wire::FrameSpansHeader& header, const std::vector<wire::FrameSpan>& spans,
                 int64_t nowNs);
    void finish(uint32_t client, uint32_t window, uint32_t frame, int64_t nowNs);

    void addRoundTrip(int node, const ClockSample& sample);
    [[nodiscard]] std::vector<NodeClock> clocks() const;
    void addNode(NodeClock clock); // the next node
    // Resets the clock of a node that starts again.
    void forgetClock(int node);

    [[nodiscard]] std::vector<FrameRecord> since(uint64_t number, int64_t nowNs,
                                                 size_t newest = FrameRing::kFrames) const;

private:
    std::atomic<bool> isOn_{false};
    mutable std::mutex mutex_; // guards the members below
    int64_t requestedNs_ = 0;
    FrameRing ring_;
    std::vector<NodeClock> clocks_;
};

} // namespace mural
