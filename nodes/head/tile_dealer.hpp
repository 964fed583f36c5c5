// Deals the tiles of queues from frame to frame, by the times that nodes report (balancer/queue), and says which areas of the
// picture that makes.
//
// Times are those of one window (FrameTimes). A lost node's tiles go to the others, until it is back.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "nodes/head/dealt_queue.hpp"
#include "nodes/head/node_plan.hpp"
#include "nodes/session/areas.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

// All calls from any thread.
class TileDealer {
public:
    // Called under the dealer's lock; must not block.
    using Announce = std::function<void(const Areas&)>;

    // plant: "areas" deals at random with each frame and each answer of each node, whatever it takes, for tests: what is drawn must stay right. So do
    // "early" and "uncleared", faults of nodes (nodes/replay/replay_areas.cpp).
    TileDealer(const SessionPlan& plan, Announce announce, const std::string& plant = {});

    void frameDone(int node, const wire::FrameDoneMessage& message);
    void answered(); // a question, in the middle of a frame: of interest to the plants only
    void windowGone(uint32_t client, uint32_t window); // or wire::kAllWindows
    void nodeLost(int node);
    void nodeJoined(int node);

    [[nodiscard]] bool deals() const { return !queues_.empty(); }
    [[nodiscard]] std::vector<QueueTotals> totals() const;

private:
    struct Queue {
        TileQueuePlan plan;
        DealtQueue tiles;
    };
    void layOut(Queue& queue); // its grid, anew
    void layOutOf(int node);   // those of its queue
    [[nodiscard]] PixelViewport pixelsOf(const Queue& queue) const;
    void dealAtRandom();
    void announce();

    mutable std::mutex mutex_;
    const Announce announce_;
    FrameTimes times_;
    std::vector<Queue> queues_;
    std::vector<Viewport> areas_; // of all nodes, the latest
    uint32_t number_ = 0;         // of them
    std::optional<std::mt19937> random_;
};

} // namespace mural
