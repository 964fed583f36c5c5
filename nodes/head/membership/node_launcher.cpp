#include "nodes/head/membership/node_launcher.hpp"

#include <algorithm>
#include <optional>
#include <poll.h>
#include <sstream>
#include <unistd.h>

#include "nodes/head/membership/node_acceptor.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "transport/tcp/route.hpp"

namespace mural {
namespace {

constexpr size_t kLocalBytes = size_t{16} << 20; // per direction between head and local node

std::string nameOf(const NodePlan& plan) { return "node " + std::to_string(plan.node) + " (" + plan.where + ")"; }

// Returns the host:port at which `host` reaches the gate; without a known route, this machine's name as the host. For a
// daemon that announces itself the host is empty, because the caller knows the route.
std::string endpointTowards(const std::string& host, uint16_t port) {
    constexpr int64_t kLookupMs = 5000;
    if (host.starts_with("@")) return endpointText("", port);
    const std::string machine = host.substr(host.find('@') + 1); // user@host
    if (const auto own = ownAddressTowards(machine, Deadline::inMs(kLookupMs)))
        return endpointText(numericText(*own), port);
    char name[256] = "localhost";
    gethostname(name, sizeof(name) - 1);
    return endpointText(name, port);
}

// Quotes a word for the remote shell of the launch command.
std::string quoted(const std::string& word) {
    if (word.find_first_of(" \t\"'\\$`*?[]()<>|&;!#~") == std::string::npos) return word;
    std::string result = "'";
    for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

std::vector<std::string> words(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> all;
    for (std::string word; stream >> word;) all.push_back(word);
    return all;
}

// The argument that makes the executable a render node.
std::string nodeWord(const LaunchOptions& options) { return options.isNative ? "--mural-node" : "node"; }

NodeCommand tcpCommand(const NodePlan& plan, const LaunchOptions& options, uint16_t port) {
    NodeCommand command;
    const std::string name = NodeAcceptor::nameOf(plan.node);
    if (plan.reach == NodeReach::Tcp) {
        command.arguments = {
            options.executable, nodeWord(options), "--as", name, "--connect", endpointText("127.0.0.1", port)};
        return command;
    }
    command.arguments = words(options.launchCommand);
    for (const std::string& word : {plan.where, quoted(options.remoteMural), nodeWord(options), std::string("--as"),
                                    name, std::string("--connect"), endpointTowards(plan.where, port)})
        command.arguments.push_back(word);
    return command;
}

Result<void> startLocal(LaunchedNode& node, const LaunchOptions& options) {
    auto offer = offerSharedMemory(kLocalBytes);
    if (!offer) return offer.error();
    const FileDescriptor peerFd(offer->peerFd);
    NodeCommand command;
    command.arguments = {options.executable, nodeWord(options), "--connect-fd", std::to_string(peerFd.get())};
    command.inheritFd = peerFd.get();
    auto process = NodeProcess::start(command);
    if (!process) return process.error();
    node.process = std::move(*process);
    node.connection = std::move(offer->connection);
    return {};
}

Result<void> startTcp(LaunchedNode& node, const LaunchOptions& options, NodeAcceptor& gate) {
    const auto secret = makeSessionSecret();
    if (!secret) return secret.error();
    NodeCommand command = tcpCommand(node.plan, options, static_cast<uint16_t>(gate.port()));
    command.standardInput = toHex(secret.value()) + "\n";
    gate.expect(node.plan.node, secret.value());
    auto process = NodeProcess::start(command);
    if (!process) return process.error();
    node.process = std::move(*process);
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

// Returns true after the node has connected. Errors: why the node failed, without its name.
Result<bool> pollConnection(LaunchedNode& node, NodeAcceptor& gate, Deadline deadline) {
    node.connection = gate.take(node.plan.node);
    if (node.connection) return true;
    // A launch command may delegate to a batch system and exit with status 0.
    const auto how = node.process->ended();
    const bool handedOver = node.plan.reach == NodeReach::LaunchCommand && how == "exit status 0";
    if (how && !handedOver) return Error{"did not start: " + *how + "; see its messages"};
    if (deadline.passed()) {
        return Error{"did not connect within 30 s; check that it can connect to port " + std::to_string(gate.port()) +
                     " of this machine"};
    }
    return false;
}

// Tolerates failed nodes as long as enough others connect.
Result<void> awaitConnections(std::vector<LaunchedNode>& nodes, NodeAcceptor* gate, const LaunchOptions& options,
                              Deadline deadline, const std::function<bool()>& cancelled) {
    const auto all = static_cast<int>(nodes.size());
    const int enough = options.minNodes > 0 ? std::min(options.minNodes, all) : all;
    std::optional<Deadline> late;
    while (true) {
        int present = 0, failed = 0;
        for (LaunchedNode& node : nodes) {
            if (!node.connection && node.absence.empty()) {
                const auto polled = pollConnection(node, *gate, deadline);
                if (!polled) node.absence = polled.error().message;
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
        poll(nullptr, 0, 20);
    }
    for (LaunchedNode& node : nodes) {
        if (node.connection || !node.absence.empty()) continue;
        node.absence = "did not connect within " + std::to_string(options.lateMs / 1000) + " s after the others";
        if (node.plan.pass.ranges > 1)
            return Error{nameOf(node.plan) + " " + node.absence + "; sort-last nodes (--db) begin together"};
        node.process.reset();
    }
    return {};
}

} // namespace

Result<std::vector<LaunchedNode>> launchNodes(const SessionPlan& plan, const LaunchOptions& options, Deadline deadline,
                                              const std::function<bool()>& cancelled) {
    auto gate = openGate(plan);
    if (!gate) return gate.error();
    std::vector<LaunchedNode> nodes;
    for (const NodePlan& planned : plan.nodes) {
        LaunchedNode node;
        node.plan = planned;
        const bool local = planned.reach == NodeReach::SharedMemory;
        const auto started = local ? startLocal(node, options) : startTcp(node, options, **gate);
        if (!started) return Error{nameOf(planned) + " did not start: " + started.error().message};
        nodes.push_back(std::move(node));
    }
    if (auto connected = awaitConnections(nodes, gate->get(), options, deadline, cancelled); !connected)
        return connected.error();
    return nodes;
}

Result<StartingNode> startNode(const NodePlan& plan, const LaunchOptions& options, Deadline deadline) {
    SessionPlan alone;
    alone.nodes.push_back(plan);
    auto gate = openGate(alone);
    if (!gate) return gate.error();
    StartingNode starting;
    starting.node.plan = plan;
    starting.gate = std::move(*gate);
    starting.deadline = deadline;
    const auto started =
        starting.gate ? startTcp(starting.node, options, *starting.gate) : startLocal(starting.node, options);
    if (!started) return Error{nameOf(plan) + " did not start: " + started.error().message};
    return starting;
}

Result<bool> connected(StartingNode& starting) {
    if (starting.node.connection) return true;
    auto present = pollConnection(starting.node, *starting.gate, starting.deadline);
    if (!present) return Error{"it " + present.error().message};
    return present;
}

} // namespace mural
