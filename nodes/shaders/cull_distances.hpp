// Whole primitives outside of a tile are dropped before they are cut and set up: the last stage before
// the rasteriser also writes gl_CullDistance. No vertex moves and none is made, so what is left comes out
// bit for bit the same. Source: accuracy M4c; ARB_cull_distance.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nodes/shaders/last_stage.hpp"

namespace mural::shaders {

// Two vec4 in the patched program:
//   [0] = left, right, lower, upper edge in normalised device coordinates
//   [1] = 0: nothing is dropped; pixels by which the edges lie outside of the tile; size of a pixel in x, y
inline constexpr const char* kCullUniform = "muralCullPlanes";

// es: in an ES context. `sources`: all texts of that stage, of which one holds main(). The same number comes back, patched where
// needed; nothing when the stage must stay as it is (gl_ClipVertex, cull distances of its own, several
// viewports or streams, names that only macros give, ES 1.00).
std::optional<std::vector<std::string>> withCullDistances(const std::vector<std::string>& sources, LastStage stage, bool es);

} // namespace mural::shaders
