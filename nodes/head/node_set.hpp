// All render nodes of the session. A packet goes to every living node or to none: the streams of all
// nodes are equal, whatever threads send.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "nodes/head/kept_stream.hpp"
#include "nodes/head/node_link.hpp"
#include "nodes/head/node_multicast.hpp"
#include "nodes/head/stream_economy.hpp"
#include "recording/stream_recorder.hpp"

namespace mural {

class NodeSet {
public:
    void add(std::unique_ptr<NodeLink> link); // before any other call
    // Carries the packets of the links that say so; before the first broadcast.
    void multicastBy(std::unique_ptr<NodeMulticast> multicast) { multicast_ = std::move(multicast); }
    [[nodiscard]] NodeMulticast* multicast() { return multicast_.get(); }
    // Gets all packets of programs, in the order in which the nodes do; outlives their senders. Before the first broadcast.
    void recordBy(recording::StreamRecorder* recorder) { recorder_ = recorder; }
    // Makes the batches for the links that get such; before the first broadcast.
    void economizeBy(std::unique_ptr<StreamEconomy> economy);
    [[nodiscard]] EconomyCounts economyCounts() const { return economy_ ? economy_->counts() : EconomyCounts(); }
    // Keeps what programs send, for nodes that come later; before the first broadcast.
    void keepBy(std::unique_ptr<KeptStream> kept) { kept_ = std::move(kept); }
    void startReading();

    // False when no node lives. Blocks while a node's connection is full.
    bool broadcast(uint32_t stream, std::span<const std::byte> payload);
    bool broadcast(wire::HeadCommand command, std::span<const std::byte> arguments);
    // To all nodes ahead of the next packet of a program, by whoever sends that; instead of one that still waits so. Never blocks.
    void leadWith(wire::HeadCommand command, std::span<const std::byte> arguments);
    // The same, but gives up when others keep the nodes busy until the deadline.
    bool broadcast(wire::HeadCommand command, Deadline deadline);
    // To one node, before it gets anything of the stream; never waits for the other nodes.
    void sendAlone(int node, wire::HeadCommand command, const std::string& json);
    void flush();
    // The same, but what nodes can do nothing with yet may stay for a moment. True: nothing has stayed.
    bool flushUseful();

    [[nodiscard]] size_t size() const { return links_.size(); }
    [[nodiscard]] int livingCount() const;
    NodeLink& link(int node) { return *links_[static_cast<size_t>(node)]; }

    // ---- nodes that come again (node_set_joins.cpp)
    // All that a node needs that comes now has been kept.
    [[nodiscard]] bool canJoin() const { return kept_ && kept_->complete(); }
    // In the place of a lost node, of which all has been said. It gets nothing yet. By the thread that adds; never waits.
    void replace(int node, std::unique_ptr<NodeLink> link);
    // Of which nodes only members can say how pictures are divided among them.
    enum class Turns { None, OfFrames, OfAreas };
    // What it is to be given first; from here on what comes waits in its link's queue. `turns`, where it is not null: members are
    // asked there whose turn it is.
    struct TurnsAsked {
        uint32_t number = 0;                // of the TellTurns
        std::function<bool(int node)> knows; // it is of the same kind
        std::vector<NodeLink*> asked;       // set: those that will answer, when they live
    };
    Result<KeptStream::Snapshot> beginCatchUp(int node, TurnsAsked* turns, Deadline deadline);
    // It is a member behind all packets so far: told to all nodes, and to `announce` before, which may refuse.
    // Where it is spared what it has had, too, a new history begins for all that are: none but its own is as short.
    struct Admission {
        bool refused = false;
        bool first = false;           // of the members that take turns
        uint32_t life = 0;            // how often it was started again
        std::vector<uint32_t> absent; // nodes that are no members
    };
    Result<void> admit(int node, const std::function<Admission(uint32_t view)>& announce);
    // From now on its packets go to it as they come. False: its queue is not empty. `now`: what is there is sent at once.
    bool goDirect(int node, bool now);
    // A member whose packets may come by multicast is told to join the group. When it has, watch() changes it over.
    void inviteToGroup(int node);

    // Also whom the multicast group has lost, and the group loses whom we have. `rerouted` hears of nodes that multicast
    // does not reach (false), or does again.
    void watch(int64_t nowNs, int64_t patienceNs, const std::function<void(int, bool)>& rerouted);
    void loseAll(const std::string& why); // those that have not said Bye
    void end();

    // The nodes that packets can't go to now: their connections are full. Empty: none is being waited for.
    [[nodiscard]] std::vector<int> full() const;

    // Bytes that each node was sent, packet headers included; where some get batches, each of those.
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_.load(std::memory_order_relaxed); }

private:
    bool sendLocked(uint32_t stream, std::span<const std::byte> payload);
    void sendLeadLocked();

    bool changesOver(const NodeMulticast::Change& came);
    void multicastLocked(std::span<const std::byte> header, std::span<const std::byte> payload);
    void sendTo(NodeLink& link, std::span<const std::byte> header, std::span<const std::byte> payload);
    void flushLocked();
    void flushLinksLocked();
    void sendBatchLocked();
    bool sendPacketLocked(uint32_t stream, std::span<const std::byte> payload);
    bool sendToLinksLocked(std::span<const std::byte> header, std::span<const std::byte> payload, bool inBatches);
    void keepLocked(uint32_t stream, std::span<const std::byte> payload);

    recording::StreamRecorder* recorder_ = nullptr; // null: nothing is recorded
    std::unique_ptr<StreamEconomy> economy_;   // null: all packets go as they are
    std::unique_ptr<NodeMulticast> multicast_; // null: every node has a stream of its own
    std::vector<NodeMulticast::Change> comers_; // watch()'s: they have joined the group, and get their packets twice until they are told
    const NodeLink* changingOver_ = nullptr;   // whose packets go to the group and to it; else null
    std::unique_ptr<KeptStream> kept_;         // null: who is lost stays so
    std::deque<std::atomic<NodeLink*>> links_; // by node
    std::vector<std::unique_ptr<NodeLink>> owned_; // also those of lost nodes: others may look at them still
    uint32_t view_ = 0;                        // counts nodes that came
    std::atomic<int> joining_{0};              // threads of such nodes that want the mutex
    std::timed_mutex sendMutex_;
    std::atomic<uint64_t> bytesSent_{0};
    std::mutex leadMutex_;
    std::map<wire::HeadCommand, std::vector<std::byte>> leads_; // the latest payload of each command that waits
    std::atomic<bool> hasLead_{false};
    static constexpr int kNobody = -1, kMulticast = -2;
    std::atomic<int> sendingTo_{kNobody}; // the node whose connection is being written to
};

} // namespace mural
