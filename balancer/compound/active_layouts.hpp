// Selects the layouts that the canvases of a configuration show. Pure.
#pragma once

#include <string>

#include "balancer/compound/frame_input.hpp"

namespace mural::compound {

// Activates the layout on every canvas that has it. wanted: the layout's name, or its number if none has that name;
// "CANVAS:NAME" for one canvas. "CANVAS:off" turns a canvas off. Returns false if no canvas has the layout.
bool activateLayout(const ResolvedConfig& config, const std::string& wanted, FrameInput& input);

} // namespace mural::compound
