// What Mural's passes do to programs that know nothing of them, these programs can do by themselves: draw for one eye,
// with samples beside the centres of their pixels. So there is something to compare with.
#pragma once

#include <optional>
#include <string>

#include "tests/programs/support/matrix.hpp"

namespace programs {

struct PassOptions {
    std::string draw = "fixed";     // --draw WAY
    float moveX = 0, moveY = 0;     // --move X,Y: the picture, in pixels
    float eye = 0, focus = 1;       // --eye X,DISTANCE: place of the eye, and where all eyes see the same
    // --screen LEFT,RIGHT,BOTTOM,TOP,DEGREES,X,Y,Z: a screen with these edges at distance 1, to whose left one turns by so
    // much, seen from there
    struct Screen {
        float left, right, bottom, top, degrees, x, y, z;
    };
    std::optional<Screen> screen;
    bool around = false; // --around: the scene is on all sides
};

// Takes them out of the arguments.
PassOptions takePassOptions(int& argc, char** argv);

// From the eye, off-axis: what lies at the distance of focus is where it is for an eye in the middle.
Matrix projectionOf(const PassOptions& options, int width, int height);

// Of the scene; things turn with the frames.
Matrix modelViewOf(const PassOptions& options, int frame);

// Triangles in front of the eyes, some through each other: place, tone, 6 floats per vertex.
constexpr int kSceneVertices = 3 * 96;
const float* sceneVertices();

} // namespace programs
