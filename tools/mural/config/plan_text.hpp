// Prints the plan of one frame: a line per task with its context.
#pragma once

#include <string>

#include "balancer/compound/frame_plan.hpp"

namespace mural::cli {

std::string planText(const config::ResolvedConfig& config, const compound::FramePlan& plan);

} // namespace mural::cli
