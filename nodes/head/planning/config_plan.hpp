// Derives the plan of a session from a configuration file: the nodes, the task of each node, and the composition of the
// wall. Pure.
//
// The program's picture maps to the surface of the canvas, or, for screens in a room, to the scene that each screen
// shows. Each draw of the compound tree becomes one render node with its area, eye, pixels, samples, phase and range.
// Nodes send their ranges to each other and everything else to the head, as in a session without a file. The frames of
// the file do not change these paths.
//
// planning/config/ plans one canvas, step by step. This module joins the plans of all canvases.
#pragma once

#include "balancer/compound/load_config.hpp"
#include "nodes/head/planning/config/plan_options.hpp"
#include "nodes/head/planning/node_plan.hpp"

namespace mural {

// Plans every canvas that shows something, unless one is named. Each canvas has its own nodes, which draw the program's
// picture at the resolution of the canvas. Errors, one line each: nothing to draw; an unsupported mix of
// decompositions.
Result<SessionPlan> planOf(const compound::LoadedConfig& loaded, const PlanOptions& options);

// The size in pixels of the first canvas that shows something, derived from the channels of its segments. 0 x 0 if
// there is none.
compound::PixelSize wallSizeOf(const compound::LoadedConfig& loaded, const PlanOptions& options);

} // namespace mural
