// Which nodes a session has that a configuration file describes, what each draws, and how the wall's picture is put
// together. Pure.
//
// The program's picture is the canvas' surface, or, where its screens stand in a room, the scene that each of them shows:
// each draw of the compound tree becomes a render node that draws its part of it, its eye, pixels, samples, turns and ranges. What frames and readback move between channels of the file,
// the session moves as it does without one: ranges from node to node, everything else to the head.
#pragma once

#include "balancer/compound/load_config.hpp"
#include "nodes/head/node_plan.hpp"

namespace mural {

struct ConfigWishes {
    std::string ownHost;
    bool here = false;                // all nodes on this machine
    std::string canvas;               // name of the one to show; empty: the first that shows anything
    std::vector<std::string> layouts; // names of those to show; canvases without any show their first
    Frusta frusta = Frusta::Auto;
    double modelUnit = 1;             // of the program, to the metre of the file
    int width = 0;                    // of the program's picture, pixels; 0: as the file has it
};

// Canvases that show something are all planned, unless one is named: each has nodes of its own, which draw the program's picture in its own pixels.
// Errors: there is nothing to draw, or a mix of decompositions that can't be put together yet; one line.
Result<SessionPlan> planOf(const compound::LoadedConfig& loaded, const ConfigWishes& wishes);

// Pixels of the first canvas that shows something, by the channels of its segments. 0 x 0: there is none.
compound::PixelSize wallSizeOf(const compound::LoadedConfig& loaded, const ConfigWishes& wishes);

} // namespace mural
