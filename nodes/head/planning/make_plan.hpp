// The plan of a session: from its configuration file, from the preset of its options, or from tiles alone.
#pragma once

#include <string>

#include "nodes/head/planning/node_plan.hpp"

namespace mural {

// ownHost: this machine's name. Errors, one line each: an unreadable or wrong configuration; nothing to draw.
Result<SessionPlan> makePlan(const SessionConfig& config, const std::string& ownHost);

} // namespace mural
