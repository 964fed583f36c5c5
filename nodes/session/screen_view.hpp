// The view of one screen in a room, such as a side of a CAVE or a tilted screen.
#pragma once

#include "common/geometry/matrix4.hpp"
#include "common/geometry/viewport.hpp"

namespace mural {

struct ScreenView {
    Viewport area;                                     // region of its picture on the wall
    double left = -1, right = 1, bottom = -1, top = 1; // edges of the screen on the plane at distance 1 from the eye
    // Transforms eye coordinates of the program to eye coordinates of the screen's view, whose axis is -z.
    Matrix4 fromProgram;

    friend bool operator==(const ScreenView&, const ScreenView&) = default;
};

} // namespace mural
