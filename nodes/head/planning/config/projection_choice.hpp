// Selects between one flat picture and the scene from the observer's eyes, and takes the observer from the
// configuration. Pure.
#pragma once

#include "nodes/head/planning/config/config_draws.hpp"

namespace mural {

// Sets the screen of each draw whose screen stands in a room. Adds the reason, and warnings, to the plan. Requires at
// least one draw.
void chooseProjection(const ConfigSource& source, ProjectionChoice choice, std::vector<ConfigDraw>& draws,
                      SessionPlan& plan);

// Takes eye distance and focus distance from the observer of the first stereo view.
void takeObserver(const config::ResolvedConfig& config, const std::vector<ConfigDraw>& draws, SessionPlan& plan);

} // namespace mural
