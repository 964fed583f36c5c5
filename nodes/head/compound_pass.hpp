// Converts the draw of a compound into the pass of a render node.
#pragma once

#include "balancer/compound/render_context.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// The product of the zooms of the compound and its ancestors. Zooms derived from whole channel pixels would differ
// between neighbours of different sizes.
[[nodiscard]] Zoom zoomOf(const config::ResolvedConfig& config, compound::Index compound);

// Clamps the zoom to kMostZoom. The caller, who knows all ranges, numbers them.
[[nodiscard]] RenderPass passOf(const config::ResolvedConfig& config, const compound::RenderContext& context);

} // namespace mural
