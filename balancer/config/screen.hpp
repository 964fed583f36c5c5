// A flat rectangle of the room that a picture is shown on: what walls and projectors come down to.
// Source: Equalizer's FrustumData; a projector's screen stands at its distance in the direction in which it looks.
#pragma once

#include "balancer/config/projection_surface.hpp"
#include "common/matrix4.hpp"
#include "common/viewport.hpp"

namespace mural::config {

struct Screen {
    Vector3 center;
    Vector3 right{1, 0, 0}; // directions of length 1
    Vector3 up{0, 1, 0};
    Vector3 normal{0, 0, 1}; // towards the viewer
    double width = 0;        // metres
    double height = 0;
    WallType type = WallType::Fixed;

    // A wall without area, or whose edges are not at right angles, is no screen.
    [[nodiscard]] bool usable() const;
    // From the room into the screen's coordinates: its centre is 0 0 0.
    [[nodiscard]] Matrix4 fromRoom() const;
    [[nodiscard]] Screen part(const Viewport& area) const;
};

Screen screenOf(const Wall& wall);
Screen screenOf(const Projection& projection);
Screen screenOf(const ProjectionSurface& surface);

} // namespace mural::config
