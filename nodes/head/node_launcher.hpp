// Starts the planned nodes, all at once, and waits until each has its connection.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "nodes/head/node_gate.hpp"
#include "nodes/head/node_plan.hpp"
#include "nodes/head/node_process.hpp"
#include "transport/connection.hpp"

namespace mural {

struct LaunchedNode {
    NodePlan plan;
    std::unique_ptr<NodeProcess> process; // null in tests with nodes in the same process
    std::unique_ptr<Connection> connection;
    std::string absence = {}; // "did not start: …": why it has no connection; empty: it has one
};

// One that is started alone, later: for a node that was lost.
struct StartingNode {
    LaunchedNode node;
    std::unique_ptr<NodeGate> gate; // null: it has its connection
    Deadline deadline = Deadline::never();
};

struct LaunchOptions {
    std::string executable;    // of `mural` here
    std::string remoteMural;   // on other hosts
    std::string launchCommand; // prefix that runs a command on a host
    int leastNodes = 0;        // so many are enough to begin: of the others those are waited for that come within lateMs; 0: all
    int64_t lateMs = 5'000;
};

// By the thread that lives as long as the nodes shall. `cancelled` is asked now and then. Errors: fewer than enough came.
Result<std::vector<LaunchedNode>> launchNodes(const SessionPlan& plan,
                                              const LaunchOptions& options,
                                              Deadline deadline,
                                              const std::function<bool()>& cancelled);

// The same for one of them, without the wait.
Result<StartingNode> startNode(const NodePlan& plan, const LaunchOptions& options, Deadline deadline);
// True: it has its connection now.
Result<bool> connected(StartingNode& starting);

} // namespace mural
