// Places drawn pictures on the wall where frames of the configuration crop, move or scale them. Pure.
#pragma once

#include "nodes/head/planning/config/config_draws.hpp"

namespace mural {

// Replaces each draw whose pictures such frames move by its parts, one draw per part of the wall. Adds warnings, and
// lines about draws without a path to the wall, to the plan.
void followFrames(const ConfigSource& source, std::vector<ConfigDraw>& draws, SessionPlan& plan);

} // namespace mural
