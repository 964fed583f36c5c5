// Transforms gl_Position in the last stage before the rasteriser, for another eye, another screen, or another place in
// the viewport.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nodes/shaders/last_stage.hpp"

namespace mural::shaders {

// Five vec4 in the patched program; zeros have no effect.
//   [0] = scale - 1 in x, y and offset in x, y of normalised device coordinates
//   [1], [2], [3] = added to x, y and w of clip coordinates: coefficients of x, y, w and 1
//   [4].x = added to z: multiple of the addition to w
// Positions with w = 1 have no perspective and are not transformed for an eye.
inline constexpr const char* kMoveUniform = "muralMove";

// As withVertexCode. Returns nothing for texts with transform feedback, whose positions must not change.
std::optional<std::vector<std::string>> withMovedPosition(const std::vector<std::string>& sources, LastStage stage, bool es);

} // namespace mural::shaders
