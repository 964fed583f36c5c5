// Positions as another eye sees them, or for another place in the viewport: the last stage before the rasteriser
// moves gl_Position.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nodes/shaders/last_stage.hpp"

namespace mural::shaders {

// Two vec4 in the patched program, zeros: nothing moves.
//   [0] = scale - 1 in x, y and offset in x, y of normalised device coordinates
//   [1] = shift of the eye as x of clip coordinates; 1 / distance of focus in units of w; 0; 0
// Positions with w = 1 are not seen in perspective: no eye shifts them.
inline constexpr const char* kMoveUniform = "muralMove";

// As withVertexCode. Transform feedback that is declared in the text keeps its positions: then nothing comes back.
std::optional<std::vector<std::string>> withMovedPosition(const std::vector<std::string>& sources, LastStage stage, bool es);

} // namespace mural::shaders
