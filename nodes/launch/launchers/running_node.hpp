// One started render node, wherever its process runs.
#pragma once

#include <optional>
#include <string>
#include <sys/types.h>

#include "common/base/clock.hpp"

namespace mural {

// Thread-safe. The destructor of an implementation ends the node.
class RunningNode {
public:
    RunningNode() = default;
    RunningNode(const RunningNode&) = delete;
    RunningNode& operator=(const RunningNode&) = delete;
    virtual ~RunningNode() = default;

    // The pid on the node's machine, or of the command that reaches it; 0: unknown.
    [[nodiscard]] virtual pid_t pid() const = 0;
    // Returns how the process ended ("exit status 3", "signal 9 (Killed)"), or nothing while it runs.
    virtual std::optional<std::string> ended() = 0;
    virtual void kill() = 0; // with its descendants
    // The command that was run, and the last lines of its output: ` of "ssh wall1 …": No route to host`. May be empty.
    [[nodiscard]] virtual std::string details() const = 0;
    // Returns true if the command may end with status 0 before its node has connected: it delegates to a batch system.
    [[nodiscard]] virtual bool mayHandOver() const { return false; }

    std::optional<std::string> waitEnded(Deadline deadline);
};

} // namespace mural
