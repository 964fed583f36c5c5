// Converts the draw of a compound into the pass of a render node.
#pragma once

#include <vector>

#include "balancer/compound/render_context.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// Returns the product of the zooms of the compound and its ancestors. Zooms derived from whole channel pixels would
// differ between neighbours of different sizes.
[[nodiscard]] Zoom zoomOf(const config::ResolvedConfig& config, compound::Index compound);

// Returns the change of that product by equalizers, relative to the file: the geometric mean of both directions.
[[nodiscard]] double zoomChangeOf(const config::ResolvedConfig& config,
                                  const std::vector<compound::CompoundState>& states, compound::Index compound);

// Returns the pass, with the zoom clamped to kMaxZoom. The caller numbers the ranges, because it has all of them.
[[nodiscard]] RenderPass passOf(const config::ResolvedConfig& config, const compound::RenderContext& context);

} // namespace mural
