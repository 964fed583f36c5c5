// Rates between two snapshots of the running sessions, and their text form. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace mural::cli {

// Returns the states of `now`, with the changes since `before` in "recent" of each session, program and node:
// framesPerSecond, callsPerFrame, bytesPerFrame, roundTripsPerFrame, waitShares; busyShare of nodes. New sessions and
// programs have none.
std::vector<nlohmann::json> withRates(const std::vector<nlohmann::json>& before, std::vector<nlohmann::json> now);

// Returns a line for the session, then one per program and node.
std::vector<std::string> statLines(const nlohmann::json& session);
// Returns only the lines of the nodes.
std::vector<std::string> nodeLines(const nlohmann::json& session);

} // namespace mural::cli
