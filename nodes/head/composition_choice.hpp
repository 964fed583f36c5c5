// How the nodes that draw ranges of one picture put it together: what the user asks for, else what a file says, else what suits
// their number.
#pragma once

#include <string>

#include "nodes/head/node_plan.hpp"

namespace mural {

// wish: auto, or a strategy by its name. Adds a line for --explain for each picture.
void chooseComposition(SessionPlan& plan, const std::string& wish);

} // namespace mural
