// Clip coordinates for another eye or another screen, as a linear function of the program's clip coordinates.
#pragma once

#include <array>

#include "nodes/replay/features/projection_detection.hpp"
#include "nodes/session/screen_view.hpp"

namespace mural {

// Added to clip coordinates x, y and w: coefficients of x, y, w and 1. Added to z: a multiple of w's addition, so that
// depth keeps the program's near and far planes.
struct ClipTransform {
    std::array<double, 4> x{}, y{}, w{};
    double z = 0;

    // Applies the transformation to a projection matrix, column-major as in OpenGL.
    void apply(double (&matrix)[16], double unit) const;
};

// Off-axis stereo: this eye is `offset` to the right of the centre, and points at `focusDistance` stay fixed. Both are
// in the program's units. The result is x_clip + K (w / focusDistance - 1), with K = offset * scaleX of the projection.
[[nodiscard]] ClipTransform eyeMove(const ProjectionDetector& seen, double offset, double focusDistance);

// A screen of a room. Source: thesis, "Virtual Reality"; Kooima, "Generalized Perspective Projection".
[[nodiscard]] ClipTransform screenMove(const ProjectionDetector& seen, const ScreenView& screen);

} // namespace mural
