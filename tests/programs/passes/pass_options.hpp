// Options with which these programs do the work of Mural's passes natively: drawing for one eye, and with samples next
// to pixel centres. Tests compare Mural's passes with them.
#pragma once

#include <optional>
#include <string>

#include "tests/programs/support/matrix.hpp"

namespace programs {

struct PassOptions {
    std::string draw = "fixed"; // --draw WAY
    float moveX = 0, moveY = 0; // --move X,Y: shift of the picture in pixels
    float eye = 0, focus = 1;   // --eye X,DISTANCE: position of the eye, and focus distance
    // --screen LEFT,RIGHT,BOTTOM,TOP,DEGREES,X,Y,Z: a screen with these edges at distance 1, turned to the left by
    // DEGREES, seen from the point X,Y,Z.
    struct Screen {
        float left, right, bottom, top, degrees, x, y, z;
    };
    std::optional<Screen> screen;
    bool around = false; // --around: the scene is on all sides
};

// Removes the options from the arguments.
PassOptions takePassOptions(int& argc, char** argv);

// Returns the off-axis projection of the eye: at the focus distance, points are where an eye in the middle sees them.
Matrix projectionOf(const PassOptions& options, int width, int height);

// Returns the scene's matrix; objects turn with the frames.
Matrix modelViewOf(const PassOptions& options, int frame);

// Triangles in front of the eyes; some intersect. Position and tone, 6 floats per vertex.
constexpr int kSceneVertices = 3 * 96;
const float* sceneVertices();

} // namespace programs
