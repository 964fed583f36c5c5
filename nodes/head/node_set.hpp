// All render nodes of the session. A packet goes to every living node or to none: the streams of all
// nodes are equal, whatever threads send.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

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
    void economizeBy(std::unique_ptr<StreamEconomy> economy) { economy_ = std::move(economy); }
    [[nodiscard]] EconomyCounts economyCounts() const { return economy_ ? economy_->counts() : EconomyCounts(); }
    void startReading();

    // False when no node lives. Blocks while a node's connection is full.
    bool broadcast(uint32_t stream, std::span<const std::byte> payload);
    bool broadcast(wire::HeadCommand command, std::span<const std::byte> arguments);
    // The same, but gives up when others keep the nodes busy until the deadline.
    bool broadcast(wire::HeadCommand command, Deadline deadline);
    void sendSetup(int node, const std::string& json);
    void flush();
    // The same, but what nodes can do nothing with yet may stay for a moment. True: nothing has stayed.
    bool flushUseful();

    [[nodiscard]] size_t size() const { return links_.size(); }
    [[nodiscard]] int livingCount() const;
    NodeLink& link(int node) { return *links_[static_cast<size_t>(node)]; }

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

    void multicastLocked(std::span<const std::byte> header, std::span<const std::byte> payload);
    void sendTo(NodeLink& link, std::span<const std::byte> header, std::span<const std::byte> payload);
    void flushLocked();
    void flushLinksLocked();
    void sendBatchLocked();
    bool sendPacketLocked(uint32_t stream, std::span<const std::byte> payload, bool inBatches);

    recording::StreamRecorder* recorder_ = nullptr; // null: nothing is recorded
    std::unique_ptr<StreamEconomy> economy_;   // null: all packets go as they are
    std::unique_ptr<NodeMulticast> multicast_; // null: every node has a stream of its own
    std::vector<std::unique_ptr<NodeLink>> links_;
    std::timed_mutex sendMutex_;
    std::atomic<uint64_t> bytesSent_{0};
    static constexpr int kNobody = -1, kMulticast = -2;
    std::atomic<int> sendingTo_{kNobody}; // the node whose connection is being written to
};

} // namespace mural
