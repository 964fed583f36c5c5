// Derives the plan of a session from a configuration file: the nodes, the task of each node, and the composition of the
// wall. Pure.
//
// The program's picture maps to the surface of the canvas, or, for screens in a room, to the scene that each screen
// shows. Each draw of the compound tree becomes one render node with its area, eye, pixels, samples, phase and range.
// Nodes send their ranges to each other and everything else to the head, as in a session without a file. The frames of
// the file do not change these paths.
#pragma once

#include "balancer/compound/load_config.hpp"
#include "nodes/head/planning/node_plan.hpp"

namespace mural {

struct PlanOptions {
    std::string ownHost;
    bool allLocal = false; // all nodes on this machine
    std::string canvas;    // name of the canvas to show; empty: all that show something
    // names of the layouts to show; a canvas without any of them shows its first layout
    std::vector<std::string> layouts;
    ProjectionChoice projection = ProjectionChoice::Auto;
    double modelUnit = 1; // units of the program per metre of the file
    int width = 0;        // of the program's picture in pixels; 0: as in the file
    balance::Balance balance = balance::Balance::AsInFile;
};

// Plans every canvas that shows something, unless one is named. Each canvas has its own nodes, which draw the program's
// picture at the resolution of the canvas. Errors, one line each: nothing to draw; an unsupported mix of
// decompositions.
Result<SessionPlan> planOf(const compound::LoadedConfig& loaded, const PlanOptions& options);

// The size in pixels of the first canvas that shows something, derived from the channels of its segments. 0 x 0 if
// there is none.
compound::PixelSize wallSizeOf(const compound::LoadedConfig& loaded, const PlanOptions& options);

} // namespace mural
