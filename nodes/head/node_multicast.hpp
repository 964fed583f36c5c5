// The one stream to the nodes of other machines: a multicast group whose host is the head. What is written goes out once,
// however many nodes there are (transport/rsp).
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "nodes/head/node_plan.hpp"
#include "nodes/session/session_secret.hpp"
#include "transport/connection.hpp"
#include "transport/rsp/group.hpp"

namespace mural {

// Which of the planned nodes get the stream by multicast, as the user's --stream says.
std::vector<int> nodesForMulticast(const std::string& stream, const SessionPlan& plan);

// All calls from any thread.
class NodeMulticast {
public:
    // `stream`: auto or rsp://…. Unless that says otherwise, the group is on the network of `path`, the way to a node, and its
    // datagrams are as long as that says.
    static Result<std::unique_ptr<NodeMulticast>> open(const std::string& stream, const NetworkPath& path);

    // What nodes are told to join with: description and secret. The control port is at the address by which they reach the
    // head.
    [[nodiscard]] std::string invitation() const;
    [[nodiscard]] const SessionSecret& secret() const { return secret_; }

    Result<void> write(std::span<const std::byte> bytes, Deadline deadline);
    [[nodiscard]] uint64_t writtenBytes() const { return writtenBytes_; }
    void flush();
    // Nobody waits for this node any longer.
    void remove(int node, const std::string& why);

    // What became of a member since the last call.
    struct Change {
        enum class Kind { Came, Rerouted, Gone };
        int node = 0;
        Kind kind = Kind::Came;
        bool multicast = false; // it is reached by it; else through its connection
        uint64_t fromByte = 0;  // came: the first of all bytes written that it gets
        std::string why;        // gone
    };
    std::vector<Change> takeChanges();
    // The nodes for which the stream waits now.
    [[nodiscard]] std::vector<int> waitsFor() const;
    [[nodiscard]] std::string describe() const; // for --explain
    [[nodiscard]] rsp::GroupReport report() const { return group_->report(); }

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
    std::map<rsp::MemberId, int> nodes_; // those that have come and are not gone
};

} // namespace mural
