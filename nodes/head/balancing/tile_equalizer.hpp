// Assigns the tiles of tile queues before each frame, from the times that nodes report (balancer/queue), and derives
// the area of each node.
//
// FrameTimes selects the window whose times count. The other nodes take over a lost node's tiles until it returns.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "nodes/head/balancing/work_queue.hpp"
#include "nodes/head/planning/node_plan.hpp"
#include "nodes/session/viewport_assignment.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

// Thread-safe.
class TileEqualizer {
public:
    // Called with the dealer's lock held; must not block.
    using Announce = std::function<void(const ViewportAssignment&)>;

    // plant: fault injection for tests. "areas" assigns tiles at random after each frame and answer of each node; the
    // picture must stay exact. "early" and "uncleared" are faults of nodes (nodes/replay/features/dynamic_tiles.cpp).
    TileEqualizer(const SessionPlan& plan, Announce announce, const std::string& plant = {});

    void frameDone(int node, const wire::FrameDoneMessage& message);
    void answered();                                   // a reply within a frame; relevant to fault injection only
    void windowGone(uint32_t client, uint32_t window); // or wire::kAllWindows
    void nodeLost(int node);
    void nodeJoined(int node);

    [[nodiscard]] bool deals() const { return !queues_.empty(); }
    [[nodiscard]] std::vector<QueueTotals> totals() const;

private:
    struct Queue {
        TileQueuePlan plan;
        WorkQueue tiles;
    };
    void layOut(Queue& queue); // rebuilds its grid
    void layOutOf(int node);   // the queue of this node
    [[nodiscard]] PixelViewport pixelsOf(const Queue& queue) const;
    void dealAtRandom();
    void announce();

    mutable std::mutex mutex_;
    const Announce announce_;
    FrameTimes times_;
    std::vector<Queue> queues_;
    std::vector<Viewport> areas_; // latest areas, per node
    uint32_t number_ = 0;         // number of the latest areas
    std::optional<std::mt19937> random_;
};

} // namespace mural
