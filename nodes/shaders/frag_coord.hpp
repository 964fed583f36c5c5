// A framebuffer of the tile's size, or one that has every nth pixel of the window only, gives fragments its own coordinates: shaders
// that read them get the window's instead, and derivatives per pixel of the window. Source: accuracy M1; GL_ARB_fragment_coord_conventions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mural::shaders {

// vec4[2]. Of the first x, y: what lies at the framebuffer's lower left corner, in the window from its lower left; z: the same height
// from both upper left corners; w: 0. Of the second x, y: how many pixels of the window one of the framebuffer stands for, less 1; z, w: one through so many,
// less 1: zeros change nothing, not even a rounding.
inline constexpr const char* kPlaceUniform = "muralPlace";

struct FragmentReads {
    bool coordinates = false; // are moved
    bool derivatives = false;
    bool gradients = false; // of texture lookups (texture_gradients.hpp)
};

// GLSL of any version. Nothing: the shader reads none of these.
std::optional<std::string> withWindowPlace(std::string_view source, const FragmentReads& reads, bool es);

// ARB_fragment_program: the same vec4s are program.env[envIndex - 1], the second, and program.env[envIndex]. Nothing: it reads no position,
// or uses these parameters itself.
std::optional<std::string> withWindowPlaceArb(std::string_view source, int envIndex);

} // namespace mural::shaders
