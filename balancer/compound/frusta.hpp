// The frusta of a context: from its view's and segment's place in the room, the observer's eyes and the head.
#pragma once

#include "balancer/compound/inheritance.hpp"

namespace mural::compound {

// Eyes in the room, in the program's units.
struct Eyes {
    Vector3 cyclop;
    Vector3 eye;
    Vector3 cyclopWithoutHead, eyeWithoutHead;
    Matrix4 head;
    double modelUnit = 1;
};

Eyes eyesOf(const ResolvedConfig& config, const FrameInput& input, Index view, Eye eye);

// What the destination's pixels show, in metres; moved to where the observer looks sharp.
config::Screen destinationScreen(const ResolvedConfig& config, const FrameInput& input, const Inherited& inherited);

// What of its view a destination channel shows.
Viewport coverage(const ResolvedConfig& config, const config::ResolvedChannel& channel);

// Sets frusta and head transforms of a context that shows the part `shown` of the destination.
void setFrusta(const config::Screen& screen, const Eyes& eyes, const Inherited& inherited, const Viewport& shown, const FrameInput& input,
               RenderContext& context);

// Cuts what a destination's frustum shows to a part of it.
Frustum partOf(const Frustum& whole, const Viewport& part);

} // namespace mural::compound
