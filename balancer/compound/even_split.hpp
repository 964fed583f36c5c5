// How equalizers divide their compounds' work before they know anything: evenly.
#pragma once

#include "balancer/compound/frame_input.hpp"

namespace mural::compound {

// Sets viewports or ranges of the children of load and tree equalizers, for the sizes that the input has.
void splitEvenly(const ResolvedConfig& config, FrameInput& input);

// Everything as the file has it, nothing measured yet.
FrameInput firstFrame(const ResolvedConfig& config);

} // namespace mural::compound
