// The head's end of the process that forks its local nodes (fork_server.hpp).
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "nodes/launch/forking/fork_protocol.hpp"
#include "nodes/launch/launchers/node_process.hpp"

namespace mural {

// Thread-safe. Its nodes share ownership of it, because they end with its process.
class NodeForker : public std::enable_shared_from_this<NodeForker> {
public:
    // Starts `executable fork-nodes`. Call from a thread that outlives the nodes. Does not wait for the driver.
    static Result<std::shared_ptr<NodeForker>> start(const std::string& executable);

    // Returns a node that serves the shared memory of `connectFd`. Blocks until the process has loaded the driver and
    // has replied. Errors: it cannot fork, or does not reply within 10 s. The caller then starts a new process instead.
    Result<std::unique_ptr<RunningNode>> fork(int connectFd);

    // Returns how a node ended (number of its request), as RunningNode::ended() does.
    std::optional<std::string> endOf(uint32_t node);

private:
    NodeForker(std::unique_ptr<NodeProcess> process, FileDescriptor control);
    // Takes all messages that have arrived. Returns the reply to a request, if it is among them.
    std::optional<ForkReply> takeReplies();

    std::mutex mutex_; // guards the members below
    std::unique_ptr<NodeProcess> process_;
    FileDescriptor control_;
    bool hasEnded_ = false;            // it sends nothing more
    std::map<uint32_t, int> statuses_; // of ended nodes by number of their request, as waitpid() returns them
};

} // namespace mural
