// The shader rewritings that a tiling needs, and the values of their uniforms. The only place where the tilings differ
// for shaders. Pure; context/tile_clipping.cpp applies them.
#pragma once

#include <GL/gl.h>
#include <array>

#include "common/geometry/pixel_viewport.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// Selects rewritings of nodes/shaders.
struct ShaderRewrites {
    bool cull = false; // drops whole primitives outside the tile
    // gl_FragCoord in window coordinates, for framebuffers of the tile or of every nth pixel
    bool windowCoordinates = false;
    bool windowDerivatives = false; // derivatives per window pixel
    bool windowGradients = false;   // texture levels from derivatives per window pixel
    bool moved = false;             // positions for another eye or another place in the viewport; excludes cull
    [[nodiscard]] bool place() const { return windowCoordinates || windowDerivatives; }
    [[nodiscard]] bool any() const { return cull || place() || moved; }
};

// Values of the added uniforms.
struct TileValues {
    std::array<GLfloat, 8> cull{};  // shaders::kCullUniform
    std::array<GLfloat, 8> place{}; // shaders::kPlaceUniform
    std::array<GLfloat, 20> move{}; // shaders::kMoveUniform
};

// The target of draws; all rectangles are in window coordinates.
struct TilePlace {
    PixelViewport window;
    PixelViewport tile;                // the visible region
    std::array<GLfloat, 4> viewport{}; // the program's own
    GLfloat marginPixels = 0;          // half of the widest line or point, plus a rounding margin
    bool mayCull = true;
    bool translated = false; // the framebuffer has the tile's size
    RenderPass pass;         // the pass of the framebuffer's pixels
};

TileValues tileValues(const TilePlace& place);

} // namespace mural
