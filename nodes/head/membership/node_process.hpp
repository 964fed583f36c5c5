// The process of one render node, or of the launch command for another host. It ends with the head, however the head
// ends.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/launch/child_process.hpp"

namespace mural {

struct NodeCommand {
    std::vector<std::string> arguments; // [0] is looked up in PATH unless it contains a '/'
    std::string standardInput;          // at most 4096 bytes
    int inheritFd = -1;                 // stays open under its number
};

// Call start() from a thread that outlives the nodes: the kernel kills them when that thread ends (PR_SET_PDEATHSIG).
// The other calls are thread-safe.
class NodeProcess {
public:
    static Result<std::unique_ptr<NodeProcess>> start(const NodeCommand& command);
    NodeProcess(const NodeProcess&) = delete;
    NodeProcess& operator=(const NodeProcess&) = delete;
    ~NodeProcess(); // kill()

    [[nodiscard]] pid_t pid() const { return pid_; }
    // Returns how the process ended ("exit status 3", "signal 9 (Killed)"), or nothing while it runs.
    std::optional<std::string> ended();
    std::optional<std::string> waitEnded(Deadline deadline);
    void kill(); // kills its descendants as well

private:
    explicit NodeProcess(launch::ChildProcess process) : pid_(process.pid()), process_(process) {}

    const pid_t pid_;
    std::mutex mutex_;
    launch::ChildProcess process_;
};

} // namespace mural
