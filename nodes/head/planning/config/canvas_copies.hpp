// Parts of canvases that other channels show again: monitors. Pure.
#pragma once

#include <vector>

#include "nodes/head/planning/config/config_draws.hpp"

namespace mural {

// Sets the places of the pictures that monitor equalizers show. They follow from the sizes of the channels alone.
void placeMonitors(const config::ResolvedConfig& config, compound::FrameInput& input);

// Removes duplicates, and joins copies that one scaled copy of their bounding box replaces. Otherwise each part would
// be averaged alone, which changes pixels at its edges.
[[nodiscard]] std::vector<CanvasCopy> joined(const std::vector<CanvasCopy>& copies);

} // namespace mural
