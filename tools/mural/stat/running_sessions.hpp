// Finds this user's running sessions on this machine by their socket names, and queries their heads.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::cli {

// Returns the session names ("mural-PID-RANDOM") in the lines of /proc/net/unix, without duplicates. Pure.
std::vector<std::string> sessionNamesIn(const std::string& unixSockets);

// Returns the state of each session (nodes/head/session/session_status.hpp), without sessions that do not answer or
// belong to others.
Result<std::vector<nlohmann::json>> queryRunningSessions();

} // namespace mural::cli
