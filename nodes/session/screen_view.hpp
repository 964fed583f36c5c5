// The view of one screen in a room, such as a side of a CAVE or a tilted screen.
#pragma once

#include "common/matrix4.hpp"
#include "common/viewport.hpp"

namespace mural {

struct ScreenView {
    Viewport area; // place of its picture on the wall
    double left = -1, right = 1, bottom = -1, top = 1; // its edges on the plane at distance 1 from the eye
    // from the program's eye coordinates to those of the eye before the screen, which looks along -z
    Matrix4 fromProgram;

    friend bool operator==(const ScreenView&, const ScreenView&) = default;
};

} // namespace mural
