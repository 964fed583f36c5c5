// Selects the compositing strategy of sort-last nodes: the user's option, then the configuration file, then the best
// for the number of nodes.
#pragma once

#include <string>

#include "nodes/head/planning/node_plan.hpp"

namespace mural {

// wish: "auto" or the name of a strategy. Adds one line per picture for --explain.
void chooseComposition(SessionPlan& plan, const std::string& name);

} // namespace mural
