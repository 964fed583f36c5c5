// Makes one render node of each draw: its group, its pass, its machine, and the names of its codec and strategy. Pure.
#pragma once

#include "nodes/head/planning/config/config_draws.hpp"
#include "nodes/head/planning/config/plan_options.hpp"

namespace mural {

// Adds the nodes to the plan. Returns the drawing channel of each node. Errors: ranges of one picture with different
// zooms; an unknown strategy or codec; a lossy codec for an exact frame.
Result<std::vector<compound::Index>> placeNodes(const ConfigSource& source, const PlanOptions& options,
                                                const std::vector<ConfigDraw>& draws, SessionPlan& plan);

} // namespace mural
