// Selects the equalizers that take effect in a session, and the nodes whose areas, ranges or zooms they change. Pure.
#pragma once

#include "balancer/equalizers/equalizer.hpp"
#include "nodes/head/planning/node_plan.hpp"

namespace mural {

// Sets `movesArea`, `movesRange` and `movesZoom` of the nodes and BalancePlan::equalizers. Adds a line with the reason
// to the plan for each equalizer without effect. Call once, after planOf().
void settleBalance(SessionPlan& plan, const SessionConfig& config);

// Returns the nodes whose work an equalizer divides, in the order of its targets.
[[nodiscard]] std::vector<int> nodesOf(const SessionPlan& plan, const balance::Equalizer& equalizer);

} // namespace mural
