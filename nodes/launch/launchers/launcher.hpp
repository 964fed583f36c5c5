// Launchers start render nodes: one implementation per way to reach other machines (docs/guide/launching.md).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "nodes/launch/launchers/running_node.hpp"

namespace mural {

// One node to start.
struct NodeTask {
    int node = 0;
    std::string host;     // as the user named it
    std::string name;     // by which it identifies itself to the head
    std::string endpoint; // HOST:PORT of the head, several separated by commas
    std::string secret;   // in hex; never an argument or in the environment, where other users can read it
};

class Launcher {
public:
    Launcher() = default;
    Launcher(const Launcher&) = delete;
    Launcher& operator=(const Launcher&) = delete;
    virtual ~Launcher() = default;

    // Starts nodes concurrently, without waiting for them. A node that cannot be started has ended. Call from one
    // thread, which outlives the nodes.
    virtual std::vector<std::unique_ptr<RunningNode>> start(const std::vector<NodeTask>& tasks) = 0;
    // False if its hosts have no names of machines, so that their routes are unknown.
    [[nodiscard]] virtual bool knowsHosts() const { return true; }
    // Returns why no node can be started any more, such as the end of a batch job. Empty: nodes can be started.
    [[nodiscard]] virtual std::string whyOver() { return {}; }
};

// Selects the program that runs as a node on other hosts.
struct NodeBinary {
    std::string mural;     // path of mural there
    std::string program;   // path of the program that draws there: mural, or a program with the native API
    bool isNative = false; // that program takes --mural-node instead of node

    // The arguments after the program's path, without the endpoint.
    [[nodiscard]] std::string nodeWord() const { return isNative ? "--mural-node" : "node"; }
};

// A node that could not be started.
class AbsentNode : public RunningNode {
public:
    // how: such as "fork: Resource temporarily unavailable"
    explicit AbsentNode(std::string how) : how_(std::move(how)) {}
    [[nodiscard]] pid_t pid() const override { return 0; }
    std::optional<std::string> ended() override { return how_; }
    void kill() override {}
    [[nodiscard]] std::string details() const override { return {}; }

private:
    const std::string how_;
};

} // namespace mural
