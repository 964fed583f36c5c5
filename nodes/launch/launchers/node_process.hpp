// The process of one render node, or of a command that reaches other hosts. It ends with this process, however that
// ends.
#pragma once

#include <csignal>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/launchers/output_lines.hpp"
#include "nodes/launch/launchers/recent_lines.hpp"
#include "nodes/launch/launchers/running_node.hpp"

namespace mural {

struct NodeCommand {
    std::vector<std::string> arguments; // [0] is looked up in PATH unless it contains a '/'
    std::string standardInput;          // at most 4096 bytes
    int inheritFd = -1;                 // stays open under its number
    // Takes the lines of both outputs, on a thread. Empty: the outputs are this process's standard error.
    std::function<void(std::string_view line)> takeLine = {};
    bool isHandedOver = false; // see RunningNode::mayHandOver()
};

// Call start() from a thread that outlives the nodes: the kernel kills them when that thread ends (PR_SET_PDEATHSIG).
// The other calls are thread-safe.
class NodeProcess : public RunningNode {
public:
    static Result<std::unique_ptr<NodeProcess>> start(const NodeCommand& command);
    ~NodeProcess() override; // kill()

    [[nodiscard]] pid_t pid() const override { return pid_; }
    // With takeLine: after the last line has been taken.
    std::optional<std::string> ended() override;
    void kill() override;
    [[nodiscard]] std::string details() const override;
    [[nodiscard]] bool mayHandOver() const override { return isHandedOver_; }

private:
    NodeProcess(launch::ChildProcess process, const NodeCommand& command);
    void capture(FileDescriptor output, const NodeCommand& command);

    const pid_t pid_;
    const std::string command_;
    const bool isHandedOver_;
    launch::RecentLines recent_;
    std::unique_ptr<launch::OutputLines> output_; // null: not captured
    std::mutex mutex_;                            // guards the members below
    launch::ChildProcess process_;
    bool isDrained_ = false;
};

// Returns a descriptor from which a process reads `text` and then the end. At most 4096 bytes; empty: /dev/null.
Result<FileDescriptor> inputOf(const std::string& text);

} // namespace mural
