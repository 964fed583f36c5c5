// Deals the tiles of queues from frame to frame, by the times that nodes report (balancer/queue), and says which areas of the
// picture that makes.
//
// It follows one window, the largest: its frames are those that times are compared for; what nodes do for other windows counts
// to them, too. A lost node's tiles go to the others, until it is back.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "balancer/queue/tile_queue.hpp"
#include "nodes/head/node_plan.hpp"
#include "nodes/session/areas.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

// Of one queue.
struct QueueTotals {
    std::string name;
    int columns = 0, rows = 0;  // of tiles; 0: no frame has told yet how large the picture is
    int width = 0, height = 0;  // of a tile, pixels
    int64_t frames = 0;         // that were compared
    int64_t moves = 0;          // after how many of them tiles moved…
    int64_t tilesMoved = 0;     // …and how many did
    int64_t taken = 0;          // frames of the window that were divided by other areas than the one before
    std::vector<std::pair<int, int>> nodes; // and how many tiles each has now
};

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
        std::vector<int> nodes;
        std::vector<int> takers; // of them, those that live
        std::optional<queue::TileQueue> tiles;
        QueueTotals totals;
        uint32_t drawnBy = 0; // number of the areas of the followed window's last frame
    };
    struct Frame {
        std::vector<double> times; // by node; below 0: it has not finished
        std::vector<uint32_t> areas;
    };
    using Window = std::pair<uint32_t, uint32_t>; // client, window

    void follow(const wire::FrameDoneMessage& message);
    void layOut(Queue& queue); // its grid, anew
    bool compare(Queue& queue, const Frame& frame);
    [[nodiscard]] PixelViewport pixelsOf(const Queue& queue) const;
    void dealAtRandom();
    void announce();
    void countTiles(Queue& queue) const;

    mutable std::mutex mutex_;
    const Announce announce_;
    std::vector<Queue> queues_;
    std::vector<Viewport> areas_; // of all nodes, the latest
    uint32_t number_ = 0;         // of them
    std::vector<bool> lives_;
    std::vector<double> work_; // by node, since its last frame of the followed window
    Window followed_{};
    int width_ = 0, height_ = 0; // of it
    int others_ = 0;             // frames of other windows since its last one
    std::map<uint32_t, Frame> frames_; // by number, of the followed window, that not all have finished
    std::optional<std::mt19937> random_;
};

} // namespace mural
