// Initial split of load and tree equalizers: even, because no measurement exists yet.
#pragma once

#include "balancer/compound/frame_input.hpp"

namespace mural::compound {

// Sets viewports or ranges of the children of load and tree equalizers for the sizes in the input.
void splitEvenly(const ResolvedConfig& config, FrameInput& input);

// Returns the state of the first frame: everything as in the file, without measurements.
FrameInput firstFrame(const ResolvedConfig& config);

} // namespace mural::compound
