// Finds this user's running sessions on this machine by their control sockets, and queries their heads.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::cli {

struct RunningSession {
    std::string name; // "mural-PID-RANDOM"; PID: the process of `mural run`
    std::string controlPath;

    bool operator==(const RunningSession&) const = default;
};

// Returns the sessions whose control sockets are in the lines of /proc/net/unix, by name, without duplicates. Pure.
std::vector<RunningSession> sessionsIn(const std::string& unixSockets);

// Returns the sessions of this user on this machine.
Result<std::vector<RunningSession>> findRunningSessions();

// Returns the state of each session (nodes/head/session/session_status.hpp), without sessions that do not reply.
Result<std::vector<nlohmann::json>> queryRunningSessions();

} // namespace mural::cli
