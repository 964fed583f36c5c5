// Drops whole primitives outside a tile before clipping and setup: the last stage before the rasteriser writes
// gl_CullDistance. Vertices are neither moved nor added, so the remaining primitives are bit-identical. Source:
// docs/decisions/0004-dropping-primitives-outside-a-tile.md; ARB_cull_distance.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nodes/shaders/last_stage.hpp"

namespace mural::shaders {

// Two vec4 in the patched program:
//   [0] = left, right, lower, upper edge in normalised device coordinates
//   [1] = x: 0 disables culling; y: margin around the tile in pixels; z, w: size of a pixel
inline constexpr const char* kCullUniform = "muralCullPlanes";

// es: in an ES context. `sources`: all texts of the stage; one contains main(). Returns as many texts, patched where
// necessary. Returns nothing if the stage must not change (gl_ClipVertex, own cull distances, several viewports or
// streams, names from macros, ES 1.00).
std::optional<std::vector<std::string>> withCullDistances(const std::vector<std::string>& sources, LastStage stage,
                                                          bool es);

} // namespace mural::shaders
