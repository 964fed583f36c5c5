// The composition of the wall: its destinations, their eyes, and the pictures that compose each. Pure.
#pragma once

#include "nodes/head/planning/config/config_draws.hpp"

namespace mural {

// Sets the wall of the plan and the picture of each draw. Adds warnings to the plan. Errors: the draws of a destination
// have different pixel or subpixel kernels.
Result<void> placeParts(const ConfigSource& source, std::vector<ConfigDraw>& draws, SessionPlan& plan);

} // namespace mural
