// Transforms gl_Position in the last stage before the rasteriser, for another eye, another screen, or another place in
// the viewport.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nodes/shaders/last_stage.hpp"

namespace mural::shaders {

// Five vec4 in the patched program; zeros have no effect.
//   Vector 0: scale - 1 in x, y and offset in x, y of normalised device coordinates.
//   Vectors 1, 2, 3: additions to x, y and w of clip coordinates, as coefficients of x, y, w and 1.
//   Vector 4, x: addition to z, as a multiple of the addition to w.
// Positions with w = 1 have no perspective and are not transformed for an eye.
inline constexpr const char* kMoveUniform = "muralMove";

// As withVertexCode. Returns nothing for texts with transform feedback, whose positions must not change.
std::optional<std::vector<std::string>> withMovedPosition(const std::vector<std::string>& sources, LastStage stage,
                                                          bool es);

} // namespace mural::shaders
