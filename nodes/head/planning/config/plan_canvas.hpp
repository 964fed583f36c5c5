// Plans one canvas of a configuration: draws, wall, nodes and windows, in this order. Pure.
#pragma once

#include "balancer/compound/load_config.hpp"
#include "nodes/head/planning/config/canvas_choice.hpp"

namespace mural {

struct PlannedCanvas {
    SessionPlan plan;
    CanvasChoice choice;
    std::vector<CanvasCopy> copies; // of all canvases
};

// Returns the size in the room. 0: the file has none.
[[nodiscard]] CanvasMillimetres millimetresOf(const config::ResolvedCanvas& canvas);

// only: plans this canvas alone. nodesBefore: number of nodes of other canvases, which precede its nodes.
Result<PlannedCanvas> planCanvas(const compound::LoadedConfig& loaded, const PlanOptions& options,
                                 compound::Index only = config::kNone, int nodesBefore = 0);

} // namespace mural
