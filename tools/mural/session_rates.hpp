// What two looks at the running sessions say about the time between them; and that in words. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace mural::cli {

// The states of `now`, with what happened since `before` in each session's, program's and node's "recent":
// framesPerSecond, callsPerFrame, bytesPerFrame, roundTripsPerFrame, waitShares; busyShare of nodes.
// A session or program that was not there before has none.
std::vector<nlohmann::json> withRates(const std::vector<nlohmann::json>& before, std::vector<nlohmann::json> now);

// A line for the session, then for each program and node.
std::vector<std::string> statLines(const nlohmann::json& session);

} // namespace mural::cli
