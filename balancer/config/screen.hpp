// A flat rectangle in the room that shows a picture: the common form of walls and projectors. Source: Equalizer's
// FrustumData; a projector's screen lies at its distance in its viewing direction.
#pragma once

#include "balancer/config/projection_surface.hpp"
#include "common/geometry/matrix4.hpp"
#include "common/geometry/viewport.hpp"

namespace mural::config {

struct Screen {
    Vector3 center;
    Vector3 right{1, 0, 0}; // unit vectors
    Vector3 up{0, 1, 0};
    Vector3 normal{0, 0, 1}; // towards the viewer
    double width = 0;        // in metres
    double height = 0;
    WallType type = WallType::Fixed;

    // Returns false for a wall without area or with edges that are not perpendicular.
    [[nodiscard]] bool usable() const;
    // Returns the transform from the room to screen coordinates, whose origin is the screen's centre.
    [[nodiscard]] Matrix4 fromRoom() const;
    [[nodiscard]] Screen part(const Viewport& area) const;
};

Screen screenOf(const Wall& wall);
Screen screenOf(const Projection& projection);
Screen screenOf(const ProjectionSurface& surface);

} // namespace mural::config
