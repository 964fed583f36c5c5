// Positions as another eye or a screen that stands elsewhere sees them, or for another place in the viewport: the last stage before the rasteriser
// moves gl_Position.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nodes/shaders/last_stage.hpp"

namespace mural::shaders {

// Five vec4 in the patched program, zeros: nothing moves.
//   [0] = scale - 1 in x, y and offset in x, y of normalised device coordinates
//   [1], [2], [3] = what is added to x, y and w of clip coordinates: so much of x, y, w and 1
//   [4].x = so much of what is added to w is added to z
// Positions with w = 1 are not seen in perspective: no eye moves them.
inline constexpr const char* kMoveUniform = "muralMove";

// As withVertexCode. Transform feedback that is declared in the text keeps its positions: then nothing comes back.
std::optional<std::vector<std::string>> withMovedPosition(const std::vector<std::string>& sources, LastStage stage, bool es);

} // namespace mural::shaders
