// Where a vertex is seen that another eye looks at, or a screen that stands elsewhere: clip coordinates as a linear
// function of the program's own.
#pragma once

#include <array>

#include "nodes/replay/seen_projection.hpp"
#include "nodes/session/screen_view.hpp"

namespace mural {

// What is added to clip coordinates x, y and w: so much of x, y, w and 1; to z: so much of what is added to w, that depth
// is told by the program's own near and far planes.
struct ViewMove {
    std::array<double, 4> x{}, y{}, w{};
    double z = 0;

    // The same for a whole projection matrix: columns of four, as OpenGL keeps them.
    void apply(double (&matrix)[16], double unit) const;
};

// Two eyes before one screen, off-axis: this one is `offset` to the right of the middle, and what lies at `focusDistance`
// stays where it is (both in the program's units). x_clip + K (w / focusDistance - 1), K = offset times the projection's
// scale of x.
[[nodiscard]] ViewMove eyeMove(const SeenProjection& seen, double offset, double focusDistance);

// A screen of a room. Source: thesis, "Virtual Reality"; Kooima, "Generalized Perspective Projection".
[[nodiscard]] ViewMove screenMove(const SeenProjection& seen, const ScreenView& screen);

} // namespace mural
