// The sessions of this user that run on this machine, found by the names of their sockets, and what their heads say.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/result.hpp"

namespace mural::cli {

// Names of sessions ("mural-PID-RANDOM") among the lines of /proc/net/unix, each once. Pure.
std::vector<std::string> sessionNamesIn(const std::string& unixSockets);

// The state of each (nodes/head/session_status.hpp); those that do not answer, or belong to others, are left out.
Result<std::vector<nlohmann::json>> askRunningSessions();

} // namespace mural::cli
