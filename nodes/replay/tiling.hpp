// What a tiling changes in the program's shaders, and the values that those changes take: the one place
// where exact, lean and further tilings differ for shaders. Pure; replay_tiling.cpp does the rest.
#pragma once

#include <GL/gl.h>
#include <array>

#include "common/pixel_viewport.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// Which rewritings of nodes/shaders are used.
struct ShaderRewrites {
    bool cull = false;              // whole primitives outside of the tile are dropped
    bool windowCoordinates = false; // gl_FragCoord is the window's: the framebuffer is the tile's, or has every nth pixel
    bool windowDerivatives = false; // derivatives are per pixel of the window
    bool windowGradients = false;   // and textures' levels are chosen by such
    bool moved = false;             // positions as another eye sees them, or moved in the viewport; instead of cull
    [[nodiscard]] bool place() const { return windowCoordinates || windowDerivatives; }
    [[nodiscard]] bool any() const { return cull || place() || moved; }
};

// Values of the uniforms that the rewritings bring in.
struct TileValues {
    std::array<GLfloat, 8> cull{};   // shaders::kCullUniform
    std::array<GLfloat, 8> place{};  // shaders::kPlaceUniform
    std::array<GLfloat, 20> move{};   // shaders::kMoveUniform
};

// Where drawing goes: all rectangles in the window's coordinates.
struct TilePlace {
    PixelViewport window;
    PixelViewport tile;              // what is let through
    std::array<GLfloat, 4> viewport{}; // the program's own
    GLfloat marginPixels = 0;        // half of the widest line or point, and something for rounding
    bool mayCull = true;
    bool translated = false;         // the framebuffer is the tile's
    RenderPass pass;                 // the framebuffer's pixels are this one's
};

TileValues tileValues(const TilePlace& place);

} // namespace mural
