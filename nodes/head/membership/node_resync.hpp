// Resync of one restarted node, on its own thread: sends the snapshot and everything after it, and makes the node a
// member when it has caught up. The other nodes continue meanwhile. Each round sends what programs have produced during
// the previous one, until a round is too short to delay a frame.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "nodes/head/broadcast/stream_broadcaster.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

class NodeResync {
public:
    // Makes the node a member, once it has caught up. Returns false if it must wait for other nodes, and is called
    // again.
    using Join = std::function<Result<bool>()>;
    // turns: for nodes whose phase or areas members report.
    NodeResync(StreamBroadcaster& nodes, int node, std::optional<StreamBroadcaster::PhaseRequest> turns, Join join);
    NodeResync(const NodeResync&) = delete;
    NodeResync& operator=(const NodeResync&) = delete;
    ~NodeResync(); // joins the thread, which ends soon after its link is lost

    void start();

    void synchronized(const wire::SynchronizedMessage& message); // the node has reached this position; thread-safe
    [[nodiscard]] bool invalid() const { return invalid_; } // the node's frames depend on frames that it has skipped
    void linkLost();                                        // thread-safe
    void phaseState(uint32_t number, const std::vector<std::byte>& turns); // thread-safe
    [[nodiscard]] bool done() const { return done_; }
    [[nodiscard]] uint64_t snapshotBytes() const { return snapshotBytes_; }
    [[nodiscard]] uint64_t queuedBytes() const { return queuedBytes_; }
    // The last frame of each program at the end of the snapshot.
    [[nodiscard]] std::vector<wire::ClientFrame> framesGiven() const {
        const std::lock_guard lock(mutex_);
        return frames_;
    }

private:
    void work();
    void sendSnapshot(const RejoinLog::Snapshot& snapshot);
    void sendQueue();
    bool sendTurns();
    void sendCommand(wire::HeadCommand command, std::span<const std::byte> arguments);
    bool synchronize(bool draws = false);
    bool drawsAgain();
    bool joins();

    StreamBroadcaster& nodes_;
    const int node_;
    NodeConnection& link_;
    std::optional<StreamBroadcaster::PhaseRequest> turns_;
    const Join join_;
    uint32_t syncNumber_ = 0; // number of the last Synchronize
    std::atomic<bool> done_{false};
    std::atomic<bool> invalid_{false};
    std::atomic<uint64_t> snapshotBytes_{0}, queuedBytes_{0};
    mutable std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    uint32_t reached_ = 0;
    uint32_t validity_ = 0; // wire::FrameValidity at that position
    bool lost_ = false;
    std::optional<std::vector<std::byte>> phase_;
    std::vector<wire::ClientFrame> frames_;
    std::thread thread_; // declared last: it uses the members above
};

} // namespace mural
