// Assigns the chunks of chunk queues before each frame, from the times that nodes report (balancer/queue). Each node
// draws one consecutive run of chunks, because draw order must not change.
//
// FrameTimes selects the window whose times count. The other nodes take over a lost node's chunks until it returns.
// Then all nodes reset to the initial shares at one position of the stream (Replay::resetShares), and new shares
// follow.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "nodes/head/balancing/work_queue.hpp"
#include "nodes/head/planning/node_plan.hpp"
#include "nodes/session/range_assignment.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

// Thread-safe.
class ChunkEqualizer {
public:
    // Called with the dealer's lock held; must not block.
    using Announce = std::function<void(const RangeAssignment&)>;

    // plant: fault injection for tests. "shares" assigns chunks at random after each frame of each node; the picture
    // must stay exact. "lateshare" is a fault of a node (Replay::moveShares).
    ChunkEqualizer(const SessionPlan& plan, Announce announce, const std::string& plant = {});

    void frameDone(int node, const wire::FrameDoneMessage& message);
    void windowGone(uint32_t client, uint32_t window); // or wire::kAllWindows
    void nodeLost(int node);
    void nodeJoined(int node);

    [[nodiscard]] bool deals() const { return !queues_.empty(); }
    [[nodiscard]] std::vector<QueueTotals> totals() const;

private:
    struct Queue {
        ChunkQueuePlan plan;
        WorkQueue chunks; // one row of columns; nodes in the order of their ranges
    };

    void layOut(Queue& queue); // resets to equal shares among living nodes
    void layOutOf(int node);
    void dealAtRandom();
    void announce();

    mutable std::mutex mutex_;
    const Announce announce_;
    FrameTimes times_;
    std::vector<Queue> queues_;
    std::vector<Range> shares_; // latest shares, per node
    uint32_t number_ = 0;       // number of the latest shares
    std::optional<std::mt19937> random_;
};

} // namespace mural
