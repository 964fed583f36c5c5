// What every channel does in one frame, as text: a line for each task, with its context.
#pragma once

#include <string>

#include "balancer/compound/frame_plan.hpp"

namespace mural::cli {

std::string planText(const config::ResolvedConfig& config, const compound::FramePlan& plan);

} // namespace mural::cli
