// Starts each node with a command of the user, such as `ssh -p 2222` or `mural call --secret FILE`, followed by the
// host and the command of the node. The node's secret is the command's standard input.
#pragma once

#include <string>

#include "nodes/launch/launchers/launcher.hpp"

namespace mural {

class CommandLauncher : public Launcher {
public:
    // command: words that precede the host
    CommandLauncher(std::vector<std::string> command, NodeBinary binary)
        : command_(std::move(command)), binary_(std::move(binary)) {}
    std::vector<std::unique_ptr<RunningNode>> start(const std::vector<NodeTask>& tasks) override;

private:
    std::unique_ptr<RunningNode> startNode(const NodeTask& task) const;

    const std::vector<std::string> command_;
    const NodeBinary binary_;
};

} // namespace mural
