// Deals the chunks of queues from frame to frame, by the times that nodes report (balancer/queue), and says which shares of a picture's draws
// that makes: each node draws one run of chunks, as what is drawn stays in its order.
//
// Times are those of one window (FrameTimes). A lost node's chunks go to the others, until it is back: then all begin with the shares of
// the start, at one place of the stream (Replay::shareAnew), and are told others behind it.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "nodes/head/dealt_queue.hpp"
#include "nodes/head/node_plan.hpp"
#include "nodes/session/shares.hpp"

namespace mural {

// All calls from any thread.
class ChunkDealer {
public:
    // Called under the dealer's lock; must not block.
    using Announce = std::function<void(const Shares&)>;

    // plant: "shares" deals at random with each frame of each node, whatever it takes, for tests: what is drawn must stay right. So does
    // "lateshare", a fault of a node (Replay::moveShares).
    ChunkDealer(const SessionPlan& plan, Announce announce, const std::string& plant = {});

    void frameDone(int node, const wire::FrameDoneMessage& message);
    void windowGone(uint32_t client, uint32_t window); // or wire::kAllWindows
    void nodeLost(int node);
    void nodeJoined(int node);

    [[nodiscard]] bool deals() const { return !queues_.empty(); }
    [[nodiscard]] std::vector<QueueTotals> totals() const;

private:
    struct Queue {
        ChunkQueuePlan plan;
        DealtQueue chunks; // columns of one row; its nodes in the order of their ranges
    };

    void layOut(Queue& queue); // evenly, among those that live
    void layOutOf(int node);
    void dealAtRandom();
    void announce();

    mutable std::mutex mutex_;
    const Announce announce_;
    FrameTimes times_;
    std::vector<Queue> queues_;
    std::vector<Range> shares_; // of all nodes, the latest
    uint32_t number_ = 0;       // of them
    std::optional<std::mt19937> random_;
};

} // namespace mural
