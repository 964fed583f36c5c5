// One queue of tiles or chunks, its assignment to nodes, and the totals for reports. Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "balancer/equalizers/tile_queue.hpp"
#include "nodes/head/frames/frame_times.hpp"
#include "nodes/head/balancing/queue_totals.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

class WorkQueue {
public:
    // Pointer to the member of a frame message that contains the number of the assignment for that frame: its areas or
    // its shares.
    using Division = uint32_t wire::FrameDoneMessage::*;

    explicit WorkQueue(std::vector<int> nodes) : nodes_(std::move(nodes)) {}

    QueueTotals totals;
    [[nodiscard]] const std::vector<int>& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<int>& takers() const { return takers_; } // the nodes that share the queue and live
    [[nodiscard]] bool has(int node) const;
    // Pieces by node; no value if nothing is assigned.
    [[nodiscard]] bool deals() const { return pieces_.has_value(); }
    [[nodiscard]] const std::vector<TileRegion>& areas() const { return pieces_->areas(); }
    [[nodiscard]] int columns() const { return pieces_->columns(); }

    // Restarts with the living nodes. Nothing is assigned until deal().
    void begin(const FrameTimes& times);
    void deal(int columns, int rows, std::vector<TileRegion> areas) {
        pieces_.emplace(columns, rows, std::move(areas));
    }
    // Assigns pieces at random, ignoring times. inOrder: pieces in one row, in the order of the nodes.
    void dealAtRandom(std::mt19937& random, bool inOrder);

    // Records that a node has finished a frame with this assignment.
    void note(int node, uint32_t division);
    // Compares the times after all nodes have finished a frame. Returns true if pieces have moved. Ignores frames of an
    // older assignment and frames without shared work.
    bool compare(const FrameTimes::Frame& frame, Division division, uint32_t latest);
    void count(); // updates the pieces per node in the totals

private:
    std::vector<int> nodes_, takers_;
    std::optional<queue::TileQueue> pieces_;
    uint32_t drawnBy_ = 0; // assignment of the last frame
};

} // namespace mural
