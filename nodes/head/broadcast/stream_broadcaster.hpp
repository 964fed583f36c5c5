// All render nodes of the session. A packet goes to every living node or to none, so that all nodes receive the same
// stream, whatever thread sends.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "nodes/head/membership/rejoin_log.hpp"
#include "nodes/head/broadcast/node_connection.hpp"
#include "nodes/head/broadcast/node_links.hpp"
#include "nodes/head/broadcast/node_multicast.hpp"
#include "nodes/head/broadcast/delta_stream.hpp"
#include "nodes/session/viewport_assignment.hpp"
#include "streamcodec/trace/stream_recorder.hpp"
#include "streamcodec/wire/head_messages.hpp"

namespace mural {

class StreamBroadcaster {
public:
    // Adds the link of the next node, before any other call; later, a link without connection, from the adding thread.
    void add(std::unique_ptr<NodeConnection> link);
    // Sets the multicast stream for links that use it. Call before the first broadcast.
    void multicastBy(std::unique_ptr<NodeMulticast> multicast) { multicast_ = std::move(multicast); }
    [[nodiscard]] NodeMulticast* multicast() { return multicast_.get(); }
    // The recorder receives all packets of programs in stream order, until endRecording() or the end of their senders.
    // Call before the first broadcast.
    void setRecorder(trace::StreamRecorder* recorder) { recorder_ = recorder; }
    // Sets the encoder of batches. Call before the first broadcast.
    void setDeltaStream(std::unique_ptr<DeltaStream> deltaStream);
    [[nodiscard]] bool hasDeltaStream() const { return deltaStream_ != nullptr; }
    [[nodiscard]] DeltaCounts deltaCounts() const { return deltaStream_ ? deltaStream_->counts() : DeltaCounts(); }
    // Sets the rejoin log. Call before the first broadcast.
    void setRejoinLog(std::unique_ptr<RejoinLog> log) { rejoinLog_ = std::move(log); }
    void startReading();

    // Returns false if no node lives. Blocks while a node's connection is full.
    bool broadcast(uint32_t stream, std::span<const std::byte> payload);
    bool broadcast(wire::HeadCommand command, std::span<const std::byte> arguments);
    // Sends a packet to one node only, on its own connection. It may overtake packets to all nodes. Dropped if the node
    // does not live. Blocks while the node's connection is full.
    void sendToNode(uint32_t node, uint32_t stream, std::span<const std::byte> payload);
    // Queues a command that precedes the next packet of a program on all nodes. Replaces a queued command of the same
    // kind. A ClockProbe gets the time at which it is sent. Never blocks.
    void scheduleBeforeNextPacket(wire::HeadCommand command, std::span<const std::byte> arguments);
    // Does the same for a command that must not wait until a program draws: the next call of sendScheduled() sends it.
    void scheduleSoon(wire::HeadCommand command, std::span<const std::byte> arguments);
    // Sends queued commands if scheduleSoon() was called since. Blocks while a node's connection is full. For threads
    // that have no packet to send.
    void sendScheduled();
    // Gives up if the connections stay full until the deadline.
    bool broadcast(wire::HeadCommand command, Deadline deadline);
    // Sends to one node before it receives any of the stream. Does not wait for other nodes.
    void sendAlone(int node, wire::HeadCommand command, const std::string& json);
    void flush();
    // Flushes, but may delay data that nodes cannot use yet. Returns true if nothing was delayed.
    bool flushActionable();

    [[nodiscard]] size_t size() const { return links_.size(); }
    [[nodiscard]] int livingCount() const;
    NodeConnection& link(int node) { return *links_[static_cast<size_t>(node)].load(); }

    // ---- recordings that begin while programs run
    // Sets the recorder, and returns the snapshot of the position at which that happens. `atPosition` runs there, with
    // the lock that orders packets. After an error the recorder may still be set: call endRecording(). Requires a
    // rejoin log.
    Result<RejoinLog::Snapshot> beginRecording(trace::StreamRecorder& recorder, const std::function<void()>& atPosition,
                                               Deadline deadline);
    // Returns false if a node accepts no data until the deadline; the recorder then stays set.
    bool endRecording(Deadline deadline);

    // ---- restarted nodes (membership_join.cpp)
    [[nodiscard]] bool hasRejoinLog() const { return rejoinLog_ != nullptr; }
    // Returns whether the rejoin log has everything that a node needs to join now.
    [[nodiscard]] bool canJoin() const { return rejoinLog_ && rejoinLog_->complete(); }
    // Replaces a lost node whose end was fully reported. The new link receives nothing yet. Call from the adding
    // thread; never blocks.
    void replace(int node, std::unique_ptr<NodeConnection> link);
    // The state that only members can report for a restarted node.
    enum class Turns { None, OfFrames, OfAreas };
    // Returns the snapshot for the node, and queues all later packets in its link. If `turns` is set, requests the
    // state of members at this position.
    struct PhaseRequest {
        uint32_t number = 0;                  // number of the RequestPhase
        std::function<bool(int node)> knows;  // the member has the same kind of state
        std::vector<NodeConnection*> members; // output: the members that will reply if they live
    };
    Result<RejoinLog::Snapshot> beginCatchUp(int node, PhaseRequest* turns, Deadline deadline);
    // Makes the node a member after all packets so far, and informs all nodes. `announce` runs first and may refuse. If
    // the node receives batches, delta coding restarts for all nodes: only an empty dictionary equals the new node's.
    struct Admission {
        bool refused = false;
        bool first = false;           // the first member with this kind of state
        uint32_t incarnation = 0;     // its incarnation
        std::vector<uint32_t> absent; // nodes that are no members
    };
    Result<void> admit(int node, const std::function<Admission(uint32_t view)>& announce);
    // Makes nodes members that have caught up, and ends the membership of others, at one position of the stream.
    struct MemberExchange {
        std::vector<int> joining, leaving;
        // Called at the position, with the lock that orders packets. Members report that they have passed `view`.
        // Returns false to refuse the exchange. May set `viewports`.
        std::function<bool(uint32_t view)> atPosition;
        std::function<Admission(int node, uint32_t view)> announce; // for each joining node, in order
        ViewportAssignment viewports; // initial areas of the joining nodes; no nodes: areas stay fixed
    };
    // Errors: refused; no memory for delta coding; a node accepts no data until the deadline. Nothing has happened
    // then.
    Result<void> exchangeMembers(const MemberExchange& exchange, Deadline deadline);
    // Switches the node's feed to its connection. Returns false if its queue is not empty. `now`: sends the queue at
    // once.
    bool goDirect(int node, bool now);
    // Ends the membership of a node at the current position: it finishes everything before, and receives nothing after.
    // Returns false if a node accepts no data until the deadline; nothing has happened then.
    bool dismiss(int node, Deadline deadline);
    // Ends the link of a node that has left or was lost for good, and frees its memory later. Call from the adding
    // thread.
    void retire(int node);
    // Invites a member to join the multicast group. watch() switches its transport after it has joined.
    void inviteToGroup(int node);

    // Loses silent nodes, and synchronises the losses of connections and multicast group. `rerouted` receives nodes
    // that multicast no longer reaches (false) or reaches again (true).
    void watch(int64_t nowNs, int64_t patienceNs, const std::function<void(int, bool)>& rerouted);
    void loseAll(const std::string& why); // all nodes that have not sent Goodbye
    void end();

    // The nodes whose full connections block the stream.
    [[nodiscard]] std::vector<int> full() const;

    // Bytes sent to each node including packet headers; with delta coding, to each node that receives batches.
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_.load(std::memory_order_relaxed); }

private:
    bool sendLocked(uint32_t stream, std::span<const std::byte> payload);
    void sendLeadLocked();
    using History = std::unique_ptr<DeltaStream::Coder>;
    Result<History> freshHistory(int node);
    void admitLocked(int node, const Admission& admission, History& history);
    void dismissLocked(int node);

    bool changesOver(const NodeMulticast::Change& came);
    void releaseReplaced();
    void multicastLocked(std::span<const std::byte> header, std::span<const std::byte> payload);
    void sendTo(NodeConnection& link, std::span<const std::byte> header, std::span<const std::byte> payload);
    void flushLocked();
    void flushLinksLocked();
    void sendBatchLocked();
    bool sendPacketLocked(uint32_t stream, std::span<const std::byte> payload);
    bool sendToLinksLocked(std::span<const std::byte> header, std::span<const std::byte> payload, bool inBatches);
    void keepLocked(uint32_t stream, std::span<const std::byte> payload);

    trace::StreamRecorder* recorder_ = nullptr; // null: no recording
    std::unique_ptr<DeltaStream> deltaStream_;  // null: no delta coding
    std::unique_ptr<NodeMulticast> multicast_;  // null: each node has its own stream
    // for watch(): group members that still receive their packets on both transports
    std::vector<NodeMulticast::Change> comers_;
    const NodeConnection* changingOver_ = nullptr; // the link that receives packets on both transports, or null
    std::unique_ptr<RejoinLog> rejoinLog_;         // null: lost nodes stay lost
    NodeLinks links_;                              // by node
    std::vector<std::unique_ptr<NodeConnection>>
        owned_;                             // includes links of lost nodes, which other threads may still use
    std::vector<NodeConnection*> replaced_; // links of lost nodes whose memory is not released yet; for watch()
    uint32_t view_ = 0;                     // number of returned nodes
    std::atomic<int> joining_{0};           // resync threads that wait for the mutex
    std::timed_mutex sendMutex_;
    std::atomic<uint64_t> bytesSent_{0};
    std::mutex leadMutex_;
    std::map<wire::HeadCommand, std::vector<std::byte>> leads_; // the latest payload of each queued command
    std::atomic<bool> hasLead_{false};
    std::atomic<bool> isLeadUrgent_{false};
    static constexpr int kNobody = -1, kMulticast = -2;
    std::atomic<int> sendingTo_{kNobody}; // the node whose connection is being written
};

} // namespace mural
