// A framebuffer of the tile's size gives fragments its own coordinates: shaders that read them get the
// window's instead. Source: accuracy M1; GL_ARB_fragment_coord_conventions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mural::shaders {

// vec4: x, y of the tile in the window from the lower left; y from the upper left; 0.
inline constexpr const char* kOffsetUniform = "muralTileOffset";

// GLSL of any version. Nothing: the shader does not read gl_FragCoord.
std::optional<std::string> withWindowCoordinates(std::string_view source, bool es);

// ARB_fragment_program: the same vec4 is program.env[envIndex]. Nothing: it reads no position, or uses
// that parameter itself.
std::optional<std::string> withWindowCoordinatesArb(std::string_view source, int envIndex);

} // namespace mural::shaders
