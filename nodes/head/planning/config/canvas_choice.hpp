// Selects the layouts and the canvas that a plan covers, and derives the sizes of canvases. Pure.
#pragma once

#include <set>

#include "nodes/head/planning/config/config_draws.hpp"
#include "nodes/head/planning/config/plan_options.hpp"

namespace mural {

// Returns the state of the first frame, with the user's layouts and model unit. Errors: no canvas has a named layout.
Result<compound::FrameInput> chooseLayouts(const ConfigSource& source, const PlanOptions& options);

struct CanvasChoice {
    compound::Index canvas = config::kNone; // the planned one
    std::set<compound::Index> canvases;     // canvases with draws, or the selected one alone
};

// Selects a canvas and removes the draws of the others, because each canvas is a separate wall. The order of selection
// is `only`, the canvas called `name`, the first canvas with draws. Errors: no draw is on a canvas of this name.
Result<CanvasChoice> chooseCanvas(const ConfigSource& source, const std::string& name, compound::Index only,
                                  std::vector<ConfigDraw>& draws);

// Returns the size in pixels of a canvas, derived from its first segment with a channel. 0 x 0: unknown.
[[nodiscard]] compound::PixelSize canvasSize(const config::ResolvedConfig& config, compound::Index canvas);

} // namespace mural
