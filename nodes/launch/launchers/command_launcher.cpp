#include "nodes/launch/launchers/command_launcher.hpp"

#include "common/log/log.hpp"
#include "nodes/launch/launchers/node_process.hpp"
#include "nodes/launch/launchers/shell_words.hpp"

namespace mural {

std::vector<std::unique_ptr<RunningNode>> CommandLauncher::start(const std::vector<NodeTask>& tasks) {
    std::vector<std::unique_ptr<RunningNode>> nodes;
    nodes.reserve(tasks.size());
    for (const NodeTask& task : tasks) nodes.push_back(startNode(task));
    return nodes;
}

std::unique_ptr<RunningNode> CommandLauncher::startNode(const NodeTask& task) const {
    NodeCommand command;
    command.arguments = command_;
    for (const std::string& word : {task.host, launch::quoted(binary_.program), binary_.nodeWord(), std::string("--as"),
                                    task.name, std::string("--connect"), task.endpoint})
        command.arguments.push_back(word);
    command.standardInput = task.secret + "\n";
    command.isHandedOver = true;
    command.takeLine = [where = "node " + std::to_string(task.node) + " (" + task.host + "): "](std::string_view line) {
        log::info(log::Topic::Launch, where, line);
    };
    auto started = NodeProcess::start(command);
    if (!started) return std::make_unique<AbsentNode>(started.error().message);
    return std::move(*started);
}

} // namespace mural
