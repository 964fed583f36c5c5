// The draw tasks of a configuration's compound trees: the first step of a plan. Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "balancer/compound/frame_flow.hpp"
#include "nodes/head/planning/config/config_source.hpp"
#include "nodes/head/planning/node_plan.hpp"

namespace mural {

// One draw task of the compound tree. It becomes one render node.
struct ConfigDraw {
    compound::RenderContext context;
    Viewport area;                    // on the canvas
    compound::Flow flow;              // the path of its frames
    std::optional<Viewport> shown;    // on the canvas, if different from area; set by followFrames()
    Zoom transferScale;               // scale of its picture in transfer; set by followFrames()
    int picture = 0;                  // index of its picture (WallPart); set by placeParts()
    std::optional<ScreenView> screen; // for a screen in a room; set by chooseProjection()
    [[nodiscard]] const Viewport& onWall() const { return shown ? *shown : area; }
};

// A part of a canvas that a channel shows although the part belongs to other channels: a picture on a monitor.
struct CanvasCopy {
    compound::Index source = config::kNone; // canvas
    Viewport from;                          // on the source
    compound::Index target = config::kNone; // canvas
    Viewport to;                            // on the target
};

struct ConfigDraws {
    std::vector<ConfigDraw> draws;
    std::vector<CanvasCopy> copies;
    std::map<compound::Index, std::string> barriers; // name of the swap barrier by window
};

// Returns the draws of all phases of a period, each once, and divides pictures evenly among the workers of a queue.
// Adds warnings to the plan.
[[nodiscard]] ConfigDraws gatherDraws(const ConfigSource& source, compound::FrameInput input, SessionPlan& plan);

} // namespace mural
