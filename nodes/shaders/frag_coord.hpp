// Makes fragment shaders independent of the framebuffer's size. A framebuffer with the tile's size, or with every nth
// pixel, changes the coordinates of fragments. Rewritten shaders read window coordinates, and derivatives per window
// pixel. Source: docs/architecture/exactness.md; GL_ARB_fragment_coord_conventions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mural::shaders {

// Two vec4 in the rewritten shader. Zeros change nothing, not even by rounding.
//   Vector 0, xy: window position of the framebuffer's lower left corner.
//   Vector 0, z: distance from the window's upper edge to the framebuffer's, for upper left origins; w: 0.
//   Vector 1, xy: window pixels per framebuffer pixel, minus 1; zw: the reciprocal, minus 1.
inline constexpr const char* kPlaceUniform = "muralPlace";

struct FragmentReads {
    bool coordinates = false; // gl_FragCoord
    bool derivatives = false;
    bool gradients = false; // of texture lookups (texture_gradients.hpp)
};

// Supports GLSL of any version. Returns nothing if the shader reads none of these.
std::optional<std::string> withWindowOffset(std::string_view source, const FragmentReads& reads, bool es);

// The same for ARB_fragment_program: the vec4s are program.env[envIndex - 1] (the second) and program.env[envIndex].
// Returns nothing if the program reads no position, or uses these parameters itself.
std::optional<std::string> withWindowOffsetArb(std::string_view source, int envIndex);

} // namespace mural::shaders
