// Where what each channel draws is shown in the end. Frames may hand on a part of it only, have it touch a part only, make
// it smaller on its way, or show it larger than it was drawn (`viewport` and `zoom` of frames): followed here, frame by
// frame, from the draws to the destinations.
#pragma once

#include <vector>

#include "balancer/compound/frame_plan.hpp"

namespace mural::compound {

// Parts are those of what the draw stands for: 0 0 1 1 is all of it, where nothing is moved.
struct ShownPart {
    Viewport from; // what of it is shown…
    Viewport to;   // …and where; the same, unless a frame's zoom shows it larger or smaller than it was drawn
    Zoom way;      // how much of its size in the end it had where it was smallest on its way; at most 1
};

struct Flow {
    bool steered = false; // frames on the way have a viewport or a zoom of their own; otherwise all is shown where it was drawn
    bool ignored = false; // they have, but a queue of the same tree says what is drawn where
    std::vector<ShownPart> parts; // of one that is steered; they do not lie over each other, but for those of other draws
};

// By context; those that nobody draws have none.
std::vector<Flow> flowOf(const ResolvedConfig& config, const FrameInput& input, const FramePlan& plan);

} // namespace mural::compound
