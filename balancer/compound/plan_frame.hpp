// From a configuration and the state of a frame to what every channel does in it. Pure: the same input gives the same
// plan, on every machine.
#pragma once

#include "balancer/compound/frame_plan.hpp"

namespace mural::compound {

FramePlan planFrame(const ResolvedConfig& config, const FrameInput& input);

} // namespace mural::compound
