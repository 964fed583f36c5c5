// The process of one render node (or of the command that starts it on another host). It ends with the
// head, whatever happens to the head.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "nodes/launch/child_process.hpp"

namespace mural {

struct NodeCommand {
    std::vector<std::string> arguments; // [0] is looked up in PATH unless it holds a '/'
    std::string standardInput;          // what the process reads there, at most 4096 bytes
    int inheritFd = -1;                 // stays open under its number
};

// start() must be called by the thread that lives as long as the nodes shall: when it ends, the kernel
// kills them (PR_SET_PDEATHSIG). The other calls may come from any thread.
class NodeProcess {
public:
    static Result<std::unique_ptr<NodeProcess>> start(const NodeCommand& command);
    NodeProcess(const NodeProcess&) = delete;
    NodeProcess& operator=(const NodeProcess&) = delete;
    ~NodeProcess(); // kill()

    [[nodiscard]] pid_t pid() const { return pid_; }
    // How it ended ("exit status 3", "signal 9 (Killed)"); nothing while it runs.
    std::optional<std::string> ended();
    std::optional<std::string> waitEnded(Deadline deadline);
    void kill(); // with everything that it has started

private:
    explicit NodeProcess(launch::ChildProcess process)
        : pid_(process.pid())
        , process_(process) {}

    const pid_t pid_;
    std::mutex mutex_;
    launch::ChildProcess process_;
};

} // namespace mural
