// Starts the planned nodes concurrently, and waits until each has connected.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/head/membership/node_acceptor.hpp"
#include "nodes/head/membership/start_progress.hpp"
#include "nodes/head/planning/node_plan.hpp"
#include "nodes/launch/forking/node_forker.hpp"
#include "nodes/launch/launchers/launcher.hpp"
#include "transport/connection.hpp"

namespace mural {

struct LaunchedNode {
    NodePlan plan;
    std::unique_ptr<RunningNode> process; // null in tests with in-process nodes
    std::unique_ptr<Connection> connection;
    std::string absence = {}; // the reason why it has no connection, "did not start: …"; empty: connected
};

// A lost node that is being restarted.
struct StartingNode {
    LaunchedNode node;
    std::unique_ptr<NodeAcceptor> gate; // null: connected
    Deadline deadline = Deadline::never();
    int64_t patienceMs = 0;
};

struct LaunchOptions {
    std::string executable;             // path of `mural`, or of the program, on this machine
    std::shared_ptr<Launcher> launcher; // of nodes on other hosts; null: there are none
    int minNodes = 0; // the session starts with this many nodes; others have lateMs to connect; 0: all nodes
    int64_t lateMs = 5'000;
    int64_t patienceMs = 30'000; // for the connection of a node
    bool isNative = false;       // nodes run a program with the native API instead of `mural`
    // Forks nodes that use shared memory. launchNodes() starts it for two nodes and more; null: nodes are new
    // processes.
    std::shared_ptr<NodeForker> forker = {};
    bool mayFork = false; // `executable` has the command fork-nodes, and nodes use the driver that it loads
};

// Call from a thread that outlives the nodes. Polls `cancelled`. Shows a table of late nodes, and again if it fails.
// progress: gains the nodes. Errors: fewer nodes than required have connected.
Result<std::vector<LaunchedNode>> launchNodes(const SessionPlan& plan, const LaunchOptions& options,
                                              StartProgress& progress, const std::function<bool()>& cancelled);

// Starts one node without waiting for its connection.
Result<StartingNode> startNode(const NodePlan& plan, const LaunchOptions& options);
// Returns true once the node has connected.
Result<bool> connected(StartingNode& starting);

} // namespace mural
