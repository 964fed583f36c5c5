#include "nodes/head/membership/node_launcher.hpp"

#include <algorithm>
#include <future>
#include <map>
#include <optional>
#include <poll.h>
#include <unistd.h>

#include "common/ipc/file_descriptor.hpp"
#include "common/log/log.hpp"
#include "nodes/head/membership/node_acceptor.hpp"
#include "nodes/launch/launchers/node_process.hpp"
#include "transport/tcp/route.hpp"

namespace mural {
namespace {

constexpr size_t kLocalBytes = size_t{16} << 20; // per direction between head and local node
constexpr int kLaunchPollMs = 5;                 // a connection is noticed within this time
constexpr size_t kMaxEndpoints = 8;              // that a node tries

std::string nameOf(const NodePlan& plan) { return "node " + std::to_string(plan.node) + " (" + plan.where + ")"; }

// Returns the endpoints at which `host` may reach the gate, HOST:PORT, separated by commas: the address on the route to
// the host, or without a known route this machine's name and addresses. For a daemon that announces itself the host is
// empty, because the caller knows the route.
std::string endpointTowards(const std::string& host, bool isKnown, uint16_t port) {
    constexpr int64_t kLookupMs = 5000;
    if (host.starts_with("@")) return endpointText("", port);
    const std::string machine = host.substr(host.find('@') + 1); // user@host
    const auto own = isKnown ? ownAddressTowards(machine, Deadline::inMs(kLookupMs)) : std::nullopt;
    if (own) return endpointText(numericText(*own), port);
    char name[256] = "localhost";
    gethostname(name, sizeof(name) - 1);
    std::string all = endpointText(name, port);
    const std::vector<std::string> addresses = ownAddresses();
    for (size_t i = 0; i < std::min(addresses.size(), kMaxEndpoints - 1); ++i)
        all += "," + endpointText(addresses[i], port);
    return all;
}

// A name server may take seconds, so all hosts are looked up at once.
std::map<std::string, std::string> endpointsTowards(const SessionPlan& plan, bool areKnown, uint16_t port) {
    std::map<std::string, std::future<std::string>> lookups;
    for (const NodePlan& node : plan.nodes)
        if (node.reach == NodeReach::LaunchCommand && !lookups.contains(node.where))
            lookups[node.where] = std::async(std::launch::async, endpointTowards, node.where, areKnown, port);
    std::map<std::string, std::string> endpoints;
    for (auto& [host, lookup] : lookups) endpoints[host] = lookup.get();
    return endpoints;
}

// The argument that makes the executable a render node.
std::string nodeWord(const LaunchOptions& options) { return options.isNative ? "--mural-node" : "node"; }

Result<void> startLocal(LaunchedNode& node, const LaunchOptions& options) {
    auto offer = offerSharedMemory(kLocalBytes);
    if (!offer) return offer.error();
    const FileDescriptor peerFd(offer->peerFd);
    node.connection = std::move(offer->connection);
    if (options.forker) {
        auto forked = options.forker->fork(peerFd.get());
        if (forked) {
            node.process = std::move(*forked);
            return {};
        }
        log::debug(log::Topic::Launch, "a node starts as a new process: ", forked.error().message);
    }
    NodeCommand command;
    command.arguments = {options.executable, nodeWord(options), "--connect-fd", std::to_string(peerFd.get())};
    command.inheritFd = peerFd.get();
    auto process = NodeProcess::start(command);
    if (!process) return process.error();
    node.process = std::move(*process);
    return {};
}

// Starts a process of this machine that is treated as remote.
Result<void> startTcp(LaunchedNode& node, const LaunchOptions& options, NodeAcceptor& gate) {
    const auto secret = makeSessionSecret();
    if (!secret) return secret.error();
    gate.expect(node.plan.node, secret.value());
    NodeCommand command;
    command.arguments = {options.executable,
                         nodeWord(options),
                         "--as",
                         NodeAcceptor::nameOf(node.plan.node),
                         "--connect",
                         endpointText("127.0.0.1", static_cast<uint16_t>(gate.port()))};
    command.standardInput = toHex(secret.value()) + "\n";
    auto process = NodeProcess::start(command);
    if (!process) return process.error();
    node.process = std::move(*process);
    return {};
}

// Starts all nodes of other hosts, in one call of the launcher.
Result<void> startRemote(const SessionPlan& plan, std::vector<LaunchedNode>& nodes, const LaunchOptions& options,
                         NodeAcceptor& gate) {
    const auto port = static_cast<uint16_t>(gate.port());
    const auto endpoints = endpointsTowards(plan, options.launcher && options.launcher->knowsHosts(), port);
    std::vector<NodeTask> tasks;
    std::vector<LaunchedNode*> remote;
    for (LaunchedNode& node : nodes) {
        if (node.plan.reach != NodeReach::LaunchCommand) continue;
        const auto secret = makeSessionSecret();
        if (!secret) return secret.error();
        gate.expect(node.plan.node, secret.value());
        tasks.push_back({node.plan.node, node.plan.where, NodeAcceptor::nameOf(node.plan.node),
                         endpoints.at(node.plan.where), toHex(secret.value())});
        remote.push_back(&node);
    }
    if (tasks.empty()) return {};
    auto started = options.launcher->start(tasks);
    for (size_t i = 0; i < started.size(); ++i) remote[i]->process = std::move(started[i]);
    return {};
}

Result<std::unique_ptr<NodeAcceptor>> openGate(const SessionPlan& plan) {
    const auto reaches = [&](NodeReach reach) {
        return std::ranges::any_of(plan.nodes, [&](const NodePlan& n) { return n.reach == reach; });
    };
    const bool remote = reaches(NodeReach::LaunchCommand);
    if (!remote && !reaches(NodeReach::Tcp)) return std::unique_ptr<NodeAcceptor>();
    return NodeAcceptor::open(!remote);
}

// The command that reaches a node on another host, and its last lines. Empty for a node of this machine.
std::string commandOf(const LaunchedNode& node) {
    if (!node.process || node.plan.reach != NodeReach::LaunchCommand) return "";
    const std::string details = node.process->details();
    return details.starts_with(" of ") ? "; its command is " + details.substr(4) : details;
}

// Returns true after the node has connected. Errors: why the node failed, without its name.
Result<bool> pollConnection(LaunchedNode& node, NodeAcceptor& gate, Deadline deadline, int64_t patienceMs) {
    node.connection = gate.take(node.plan.node);
    if (node.connection) return true;
    const auto how = node.process ? node.process->ended() : std::nullopt;
    const bool isHandedOver = how == "exit status 0" && node.process->mayHandOver();
    if (how && !isHandedOver) return Error{"did not start: " + *how + node.process->details()};
    if (deadline.passed()) {
        return Error{"did not connect within " + std::to_string(patienceMs / 1000) + " s" + commandOf(node) +
                     "; check that it can connect to port " + std::to_string(gate.port()) +
                     " of this machine, or raise --start-timeout"};
    }
    return false;
}

void show(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) log::info(log::Topic::Node, line);
}

// The reason why a node is late, as far as the output of its command shows it.
std::string whyLate(const std::vector<LaunchedNode>& nodes, int node) {
    for (const LaunchedNode& n : nodes) {
        if (n.plan.node != node || !n.process || n.plan.reach != NodeReach::LaunchCommand) continue;
        const std::string details = n.process->details();
        return details.starts_with(" of ") ? details.substr(4) : details.substr(std::min<size_t>(2, details.size()));
    }
    return "";
}

// Tolerates failed nodes as long as enough others connect.
Result<void> awaitConnections(std::vector<LaunchedNode>& nodes, NodeAcceptor* gate, const LaunchOptions& options,
                              StartProgress& progress, const std::function<bool()>& cancelled) {
    const Deadline deadline = Deadline::inMs(options.patienceMs);
    const auto all = static_cast<int>(nodes.size());
    const int enough = options.minNodes > 0 ? std::min(options.minNodes, all) : all;
    std::optional<Deadline> late;
    while (true) {
        int present = 0, failed = 0;
        for (LaunchedNode& node : nodes) {
            if (!node.connection && node.absence.empty()) {
                const auto polled = pollConnection(node, *gate, deadline, options.patienceMs);
                if (polled && polled.value()) progress.reached(node.plan.node, StartStep::Connected, monotonicNowNs());
                if (!polled) node.absence = polled.error().message;
                if (!polled) progress.giveUp(node.plan.node);
                if (!polled) node.process.reset();
            }
            present += node.connection ? 1 : 0;
            failed += node.absence.empty() ? 0 : 1;
            if (all - failed < enough)
                return Error{nameOf(node.plan) + " " + node.absence +
                             (enough < all ? "; fewer than --min-nodes " + std::to_string(enough) + " are left" : "")};
            if (!node.absence.empty() && node.plan.pass.ranges > 1)
                return Error{nameOf(node.plan) + " " + node.absence + "; sort-last nodes (--db) begin together"};
        }
        if (present + failed == all) return {};
        if (present >= enough && !late) late = Deadline::inMs(options.lateMs);
        if (late && late->passed()) break;
        if (cancelled()) return Error{"the session was stopped before it began"};
        show(progress.news(StartStep::Connected, monotonicNowNs(), [&](int node) { return whyLate(nodes, node); }));
        poll(nullptr, 0, kLaunchPollMs);
    }
    for (LaunchedNode& node : nodes) {
        if (node.connection || !node.absence.empty()) continue;
        node.absence =
            "did not connect within " + std::to_string(options.lateMs / 1000) + " s after the others" + commandOf(node);
        if (node.plan.pass.ranges > 1)
            return Error{nameOf(node.plan) + " " + node.absence + "; sort-last nodes (--db) begin together"};
        progress.giveUp(node.plan.node);
        node.process.reset();
    }
    return {};
}

} // namespace

Result<std::vector<LaunchedNode>> launchNodes(const SessionPlan& plan, const LaunchOptions& options,
                                              StartProgress& progress, const std::function<bool()>& cancelled) {
    const int64_t beganNs = monotonicNowNs();
    auto gate = openGate(plan);
    if (!gate) return gate.error();
    std::vector<LaunchedNode> nodes;
    for (const NodePlan& planned : plan.nodes) {
        nodes.emplace_back().plan = planned;
        progress.add(planned.node, planned.where);
    }
    // Remote nodes first, because their way is longer.
    if (const auto started = *gate ? startRemote(plan, nodes, options, **gate) : Result<void>(); !started)
        return started.error();
    for (LaunchedNode& node : nodes) {
        const bool isShared = node.plan.reach == NodeReach::SharedMemory;
        const auto started = isShared                            ? startLocal(node, options)
                             : node.plan.reach == NodeReach::Tcp ? startTcp(node, options, **gate)
                                                                 : Result<void>();
        if (!started) return Error{nameOf(node.plan) + " did not start: " + started.error().message};
        progress.reached(node.plan.node, isShared ? StartStep::Connected : StartStep::Launched, monotonicNowNs());
    }
    const auto connected = awaitConnections(nodes, gate->get(), options, progress, cancelled);
    if (connected) return nodes;
    if (monotonicNowNs() - beganNs < StartProgress::kLateMs * kNsPerMs) return connected.error();
    const auto late =
        progress.table(StartStep::Connected, monotonicNowNs(), [&](int node) { return whyLate(nodes, node); });
    show(late); // the error describes one node
    return connected.error();
}

Result<StartingNode> startNode(const NodePlan& plan, const LaunchOptions& options) {
    SessionPlan alone;
    alone.nodes.push_back(plan);
    auto gate = openGate(alone);
    if (!gate) return gate.error();
    StartingNode starting;
    starting.gate = std::move(*gate);
    starting.deadline = Deadline::inMs(options.patienceMs);
    starting.patienceMs = options.patienceMs;
    std::vector<LaunchedNode> nodes(1);
    nodes.front().plan = plan;
    const auto started = plan.reach == NodeReach::SharedMemory ? startLocal(nodes.front(), options)
                         : plan.reach == NodeReach::Tcp        ? startTcp(nodes.front(), options, *starting.gate)
                                                               : startRemote(alone, nodes, options, *starting.gate);
    if (!started) return Error{nameOf(plan) + " did not start: " + started.error().message};
    starting.node = std::move(nodes.front());
    return starting;
}

Result<bool> connected(StartingNode& starting) {
    if (starting.node.connection) return true;
    auto present = pollConnection(starting.node, *starting.gate, starting.deadline, starting.patienceMs);
    if (!present) return Error{"it " + present.error().message};
    return present;
}

} // namespace mural
