// What one screen of a room (a cave's wall, a screen at an angle) shows of a program's scene.
#pragma once

#include "common/matrix4.hpp"
#include "common/viewport.hpp"

namespace mural {

struct ScreenView {
    Viewport area;                                     // where its picture lies on the wall's
    double left = -1, right = 1, bottom = -1, top = 1; // its edges, on the plane at distance 1 from the eye
    Matrix4 fromProgram; // from the program's eye coordinates to those of the eye before the screen, which looks along -z

    friend bool operator==(const ScreenView&, const ScreenView&) = default;
};

} // namespace mural
