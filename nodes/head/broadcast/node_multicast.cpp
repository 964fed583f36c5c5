#include "nodes/head/broadcast/node_multicast.hpp"

#include <random>
#include <set>

#include "nodes/head/membership/node_acceptor.hpp"
#include "transport/connection_description.hpp"
#include "transport/rsp/group_description.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {
namespace {

constexpr uint16_t kPort = 4277;
// Tolerates nodes that draw for long or are stopped briefly. The head has its own limit for silent nodes.
constexpr int64_t kSilentMs = 5000;

std::string machineOf(const std::string& host) { return host.substr(host.find('@') + 1); } // user@host

// Each session uses its own group, so that hosts receive no foreign traffic.
std::string freshGroup(const std::string& ownAddress) {
    const auto last = std::to_string(std::random_device()() % 254 + 1);
    return ownAddress.find(':') != std::string::npos ? endpointText("ff15::4d75:7261:" + last, kPort)
                                                     : endpointText("239.255.77." + last, kPort);
}

const char* textOf(rsp::GoneReason reason) {
    switch (reason) {
    case rsp::GoneReason::Silent:
        return "no datagram and no message over TCP from it (stopped, or its network is disconnected)";
    case rsp::GoneReason::Stalled: return "it did not receive the stream for too long";
    case rsp::GoneReason::Left:
    case rsp::GoneReason::Cut:
    case rsp::GoneReason::Removed: break;
    }
    return "it left the multicast group";
}

} // namespace

std::vector<int> nodesForMulticast(const std::string& stream, const SessionPlan& plan) {
    std::vector<int> nodes;
    if (stream == "tcp") return nodes;
    std::set<std::string> machines;
    for (const NodePlan& node : plan.nodes) {
        const bool far = node.reach == NodeReach::LaunchCommand || (stream != "auto" && node.reach == NodeReach::Tcp);
        if (!far) continue;
        nodes.push_back(node.node);
        machines.insert(machineOf(node.where));
    }
    if (stream == "auto" && machines.size() < 2) nodes.clear();
    return nodes;
}

Result<std::unique_ptr<NodeMulticast>> NodeMulticast::open(const std::string& stream, const NetworkPath& path) {
    ConnectionDescription description;
    if (stream == "auto") {
        description = *parseConnectionDescription("rsp://" + freshGroup(path.ownAddress));
    } else {
        auto given = parseConnectionDescription(stream);
        if (!given) return given.error();
        description = *given;
    }
    auto options = rsp::groupOptionsOf(description);
    if (!options) return options.error();
    const auto& given = description.parameters;
    if (!given.contains("interface")) options->interface = path.ownAddress;
    if (!given.contains("datagram")) options->datagramBytes = std::min(path.datagramBytes, rsp::kMaxDatagramBytes);
    if (!given.contains("control")) options->control = ":0";
    if (!given.contains("stalled")) options->stalled = rsp::StallPolicy::Wait;
    if (!given.contains("silent-ms")) options->silentMs = kSilentMs;
    auto secret = makeSessionSecret(); // on error, nodes use their own connections
    if (!secret) return secret.error();
    options->secret = *secret;
    auto group = rsp::Group::host(*options);
    if (!group) return group.error();
    return std::unique_ptr<NodeMulticast>(new NodeMulticast(std::move(*group), *options));
}

NodeMulticast::NodeMulticast(std::unique_ptr<rsp::Group> group, const rsp::GroupOptions& options)
    : group_(std::move(group)),
      description_(
          options.group + " on " + (options.interface.empty() ? "the first network" : options.interface) + ", " +
          rsp::nameOf(options.seal) +
          (options.datagramBytes > 0 ? ", datagrams of " + std::to_string(options.datagramBytes) + " bytes" : "")),
      groupAddress_(options.group),
      secret_(options.secret) {
    if (auto control = splitHostPort(group_->controlAddress())) controlPort_ = control->port;
}

std::string NodeMulticast::invitation() const {
    return "rsp://" + groupAddress_ + "?control=" + endpointText("", controlPort_);
}

Result<void> NodeMulticast::write(std::span<const std::byte> bytes, Deadline deadline) {
    writtenBytes_ += bytes.size();
    return group_->write(bytes, deadline); // complete, unless the group has failed
}
void NodeMulticast::flush() { group_->flush(); }

rsp::MemberId NodeMulticast::memberOf(int node) const {
    for (const auto& [member, n] : nodes_)
        if (n == node) return member;
    return rsp::kHost;
}

std::map<int, NodeMulticast::Losses> NodeMulticast::losses() const {
    const rsp::GroupReport now = group_->report();
    const std::lock_guard lock(mutex_);
    std::map<int, Losses> result;
    for (const rsp::GroupReport::Member& member : now.members)
        if (const auto node = nodes_.find(member.id); node != nodes_.end())
            result[node->second] = {member.state.lost, member.state.dropped};
    return result;
}

void NodeMulticast::remove(int node, const std::string& why) {
    rsp::MemberId member = rsp::kHost;
    {
        const std::lock_guard lock(mutex_);
        member = memberOf(node);
    }
    if (member != rsp::kHost) group_->remove(member, why);
}

std::vector<NodeMulticast::Change> NodeMulticast::takeChanges() {
    std::vector<Change> changes;
    const std::lock_guard lock(mutex_);
    for (const rsp::MemberEvent& event : group_->takeEvents()) {
        const auto node = NodeAcceptor::nodeOf(event.info.name);
        if (!node) continue;
        if (event.kind == rsp::MemberEvent::Kind::Gone) {
            nodes_.erase(event.id);
            // A node that leaves or ends reports it on its own connection as well, after its earlier messages.
            const bool itself = event.reason == rsp::GoneReason::Left || event.reason == rsp::GoneReason::Cut;
            if (!itself) changes.push_back({*node, Change::Kind::Gone, false, 0, textOf(event.reason)});
            continue;
        }
        nodes_[event.id] = *node;
        const auto kind = event.kind == rsp::MemberEvent::Kind::Came ? Change::Kind::Came : Change::Kind::Rerouted;
        changes.push_back({*node, kind, event.info.multicast, event.info.fromByte, {}});
    }
    return changes;
}

std::vector<int> NodeMulticast::waitsFor() const {
    std::vector<int> nodes;
    const auto report = group_->report();
    const std::lock_guard lock(mutex_);
    for (const auto& member : report.members) {
        const auto found = nodes_.find(member.id);
        if (found != nodes_.end() && member.waitedFor) nodes.push_back(found->second);
    }
    return nodes;
}

std::string NodeMulticast::describe() const { return description_; }

} // namespace mural
