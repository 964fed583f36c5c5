// The multicast stream to the nodes of other machines, with the head as host of the group. Written data is sent once,
// for any number of nodes (transport/rsp).
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/head/planning/node_plan.hpp"
#include "nodes/session/session_secret.hpp"
#include "transport/connection.hpp"
#include "transport/rsp/group.hpp"

namespace mural {

// Selects the planned nodes that receive the stream by multicast, from the user's --stream.
std::vector<int> nodesForMulticast(const std::string& stream, const SessionPlan& plan);

// Thread-safe.
class NodeMulticast {
public:
    // stream: auto or rsp://…. Unless that names them, the interface and the datagram size come from `path`, the route
    // to a node.
    static Result<std::unique_ptr<NodeMulticast>> open(const std::string& stream, const NetworkPath& path);

    // Returns the data that nodes need to join: the description and the secret. The control port is at the address by
    // which they reach the head.
    [[nodiscard]] std::string invitation() const;
    [[nodiscard]] const SessionSecret& secret() const { return secret_; }

    Result<void> write(std::span<const std::byte> bytes, Deadline deadline);
    [[nodiscard]] uint64_t writtenBytes() const { return writtenBytes_; }
    void flush();
    // Removes a node, for which the stream then no longer waits.
    void remove(int node, const std::string& why);

    // A membership change since the last call.
    struct Change {
        enum class Kind { Came, Rerouted, Gone };
        int node = 0;
        Kind kind = Kind::Came;
        bool multicast = false; // multicast reaches it; otherwise its tunnel
        uint64_t fromByte = 0;  // joined: offset of the first byte that it receives
        std::string why;        // left: the reason
    };
    std::vector<Change> takeChanges();
    // The nodes whose acknowledgement the stream waits for.
    [[nodiscard]] std::vector<int> waitsFor() const;
    [[nodiscard]] std::string describe() const; // for --explain
    [[nodiscard]] rsp::GroupReport report() const { return group_->report(); }
    // Datagrams of the stream that a member has lost, as it reports them. Others or the head repaired them.
    struct Losses {
        uint32_t lost = 0;    // in the network
        uint32_t dropped = 0; // by its socket
    };
    [[nodiscard]] std::map<int, Losses> losses() const; // by node

private:
    NodeMulticast(std::unique_ptr<rsp::Group> group, const rsp::GroupOptions& options);
    [[nodiscard]] rsp::MemberId memberOf(int node) const;

    const std::unique_ptr<rsp::Group> group_;
    const std::string description_;
    const std::string groupAddress_;
    const SessionSecret secret_;
    uint16_t controlPort_ = 0;
    std::atomic<uint64_t> writtenBytes_{0};
    mutable std::mutex mutex_;
    std::map<rsp::MemberId, int> nodes_; // current members
};

} // namespace mural
