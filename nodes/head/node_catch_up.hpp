// Gives one node that has come back what it has missed, by a thread of its own, and makes it a member when it has caught up.
// The others go on meanwhile. What programs send while it reads what was kept is sent behind that, what they send meanwhile
// behind that again, until a round is so short that waiting for this node does not show in a frame.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "nodes/head/node_set.hpp"

namespace mural {

class NodeCatchUp {
public:
    using Admitted = std::function<NodeSet::Admission(uint32_t view)>; // hears in which view it becomes a member
    // turns: of nodes that take turns.
    NodeCatchUp(NodeSet& nodes, int node, std::optional<NodeSet::TurnsAsked> turns, Admitted admitted);
    NodeCatchUp(const NodeCatchUp&) = delete;
    NodeCatchUp& operator=(const NodeCatchUp&) = delete;
    ~NodeCatchUp(); // waits until it is done: soon, once its link is lost

    void start();

    void synchronized(const wire::SynchronizedMessage& message); // the node has come to there; from any thread
    [[nodiscard]] bool unsound() const { return unsound_; } // its frames need those that it has not drawn
    void linkLost();                    // from any thread
    void toldTurns(uint32_t number, const std::vector<std::byte>& turns); // from any thread
    [[nodiscard]] bool done() const { return done_; }
    [[nodiscard]] uint64_t snapshotBytes() const { return snapshotBytes_; }
    [[nodiscard]] uint64_t queuedBytes() const { return queuedBytes_; }
    // That programs had shown where what it was given first ends.
    [[nodiscard]] std::vector<wire::ClientFrame> framesGiven() const {
        const std::lock_guard lock(mutex_);
        return frames_;
    }

private:
    void work();
    void sendSnapshot(const KeptStream::Snapshot& snapshot);
    void sendQueue();
    bool sendTurns();
    void sendCommand(wire::HeadCommand command, std::span<const std::byte> arguments);
    bool synchronize(bool draws = false);
    bool drawsAgain();

    NodeSet& nodes_;
    const int node_;
    NodeLink& link_;
    std::optional<NodeSet::TurnsAsked> turns_;
    const Admitted admitted_;
    uint32_t asked_ = 0; // number of the last Synchronize
    std::atomic<bool> done_{false};
    std::atomic<bool> unsound_{false};
    std::atomic<uint64_t> snapshotBytes_{0}, queuedBytes_{0};
    mutable std::mutex mutex_; // what follows
    std::condition_variable changed_;
    uint32_t reached_ = 0;
    uint32_t sound_ = 0; // there: wire::Soundness
    bool lost_ = false;
    std::optional<std::vector<std::byte>> told_;
    std::vector<wire::ClientFrame> frames_;
    std::thread thread_; // last: it uses all of it
};

} // namespace mural
