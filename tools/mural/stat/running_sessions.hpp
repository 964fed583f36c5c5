// Finds this user's running sessions on this machine by their control sockets, and queries their heads.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::cli {

struct RunningSession {
    std::string name; // "mural-PID-RANDOM"; PID: the process of `mural run`
    std::string controlPath;

    bool operator==(const RunningSession&) const = default;
};

// Returns whether a word of the command line names the session: its name, or the pid of its `mural run`.
bool isCalled(const RunningSession& session, const std::string& word);

// Returns the sessions whose control sockets are in the lines of /proc/net/unix, by name, without duplicates. Pure.
std::vector<RunningSession> sessionsIn(const std::string& unixSockets);

// Returns the sessions of this user on this machine. `session`: as for isCalled(); empty: all.
Result<std::vector<RunningSession>> findRunningSessions(const std::string& session = "");

// Returns the state of each session (nodes/head/session/session_status.hpp), without sessions that do not reply.
Result<std::vector<nlohmann::json>> queryRunningSessions(const std::string& session = "");

// Returns the statistics of the session's frames from this number on, and requests further ones for some seconds
// (docs/reference/statistics.md). newest: limit of their number, which leaves older ones out; 0: none. Empty: the
// session does not reply.
std::optional<nlohmann::json> queryFrames(const std::string& controlPath, uint64_t sinceFrame, int newest = 0);

// Returns the latest proofs that the outputs are alive, and requests the next ones (docs/reference/control.md,
// operation `outputs`). Empty: the session does not reply.
std::optional<nlohmann::json> queryOutputs(const std::string& controlPath);

} // namespace mural::cli
