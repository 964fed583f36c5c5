// Frusta of a context, from the place of view and segment in the room, the observer's eyes, and the head transform.
#pragma once

#include "balancer/compound/inheritance.hpp"

namespace mural::compound {

// Eye positions in the room, in program units.
struct Eyes {
    Vector3 cyclop;
    Vector3 eye;
    Vector3 cyclopWithoutHead, eyeWithoutHead;
    Matrix4 head;
    double modelUnit = 1;
};

Eyes eyesOf(const ResolvedConfig& config, const FrameInput& input, Index view, Eye eye);

// Returns the screen of the destination's pixels, in metres, moved to the observer's focus distance.
config::Screen destinationScreen(const ResolvedConfig& config, const FrameInput& input, const Inherited& inherited);

// Returns the part of its view that a destination channel shows.
Viewport coverage(const ResolvedConfig& config, const config::ResolvedChannel& channel);

// Sets frusta and head transforms of a context that shows the part `shown` of the destination.
void setFrusta(const config::Screen& screen, const Eyes& eyes, const Inherited& inherited, const Viewport& shown,
               const FrameInput& input, RenderContext& context);

// Returns the frustum of a part of the area that `whole` covers.
Frustum partOf(const Frustum& whole, const Viewport& part);

} // namespace mural::compound
