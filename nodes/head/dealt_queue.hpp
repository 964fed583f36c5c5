// One queue of pieces, tiles or chunks, between the nodes that take them, and what became of it. Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "balancer/queue/tile_queue.hpp"
#include "nodes/head/frame_times.hpp"
#include "nodes/head/queue_totals.hpp"

namespace mural {

class DealtQueue {
public:
    // The number by which a frame says how it was divided.
    using Division = uint32_t wire::FrameDoneMessage::*;

    explicit DealtQueue(std::vector<int> nodes) : nodes_(std::move(nodes)) {}

    QueueTotals totals;
    [[nodiscard]] const std::vector<int>& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<int>& takers() const { return takers_; } // of them, those that live
    [[nodiscard]] bool has(int node) const;
    // By taker; none: nothing is dealt.
    [[nodiscard]] bool deals() const { return pieces_.has_value(); }
    [[nodiscard]] const std::vector<TileRegion>& areas() const { return pieces_->areas(); }
    [[nodiscard]] int columns() const { return pieces_->columns(); }

    // Anew, among those that live: nothing is dealt until deal().
    void begin(const FrameTimes& times);
    void deal(int columns, int rows, std::vector<TileRegion> areas) { pieces_.emplace(columns, rows, std::move(areas)); }
    // Whatever it takes; inOrder: areas of one row, in the order of the takers.
    void dealAtRandom(std::mt19937& random, bool inOrder);

    // A node has finished a frame that was divided so.
    void note(int node, uint32_t division);
    // All have; true: pieces have moved. A frame of another division than the one announced last, or of which nothing was shared, says nothing.
    bool compare(const FrameTimes::Frame& frame, Division division, uint32_t latest);
    void count(); // who has how many

private:
    std::vector<int> nodes_, takers_;
    std::optional<queue::TileQueue> pieces_;
    uint32_t drawnBy_ = 0; // number of the last frame's division
};

} // namespace mural
