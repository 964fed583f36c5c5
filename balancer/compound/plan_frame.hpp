// Computes the plan of one frame from a configuration and the frame's state. Pure: equal inputs give equal plans on
// every machine.
#pragma once

#include "balancer/compound/frame_plan.hpp"

namespace mural::compound {

FramePlan planFrame(const ResolvedConfig& config, const FrameInput& input);

} // namespace mural::compound
