// Computes the plan of one frame from a configuration and the frame's state. Pure: equal inputs give equal plans on
// every machine.
#pragma once

#include "balancer/compound/frame_plan.hpp"

namespace mural::compound {

// Missing values of the input have their defaults; missing sizes are those of displaySizes(config). The plan may
// reuse the memory of an old plan; the contents of `old` do not matter.
FramePlan planFrame(const ResolvedConfig& config, const FrameInput& input, FramePlan old = {});

} // namespace mural::compound
