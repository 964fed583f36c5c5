// Traces the pixels of each draw to the destinations that show them. Frames may crop, restrict or scale a picture
// (attributes `viewport` and `zoom` of frames), so the trace follows every frame from draw to destination.
#pragma once

#include <vector>

#include "balancer/compound/frame_plan.hpp"

namespace mural::compound {

// Parts are relative to the area that the draw represents: 0 0 1 1 is all of it, unmoved.
struct ShownPart {
    Viewport from;      // shown part of the draw
    Viewport to;        // its place; equal to `from` unless a frame's zoom scales it
    Zoom transferScale; // smallest scale on the path relative to the final scale; at most 1
};

struct Flow {
    // a frame on the path has a viewport or zoom; otherwise everything is shown where it was drawn
    bool steered = false;
    bool ignored = false;         // a viewport or zoom exists, but a queue of the same tree determines the places
    std::vector<ShownPart> parts; // of a steered draw; disjoint, except with parts of other draws
};

// A part of a draw that a channel shows although the draw belongs to another destination: a picture on a monitor.
struct ShownCopy {
    Index context = kNone; // of the draw
    Index channel = kNone; // that shows it
    Viewport from;         // part of the draw
    Viewport to;           // part of the channel
};

// Returns the flow of each context. Contexts without a draw have no parts.
std::vector<Flow> flowOf(const ResolvedConfig& config, const FrameInput& input, const FramePlan& plan);

// Returns the copies of all channels, of one eye.
std::vector<ShownCopy> copiesOf(const ResolvedConfig& config, const FrameInput& input, const FramePlan& plan);

} // namespace mural::compound
