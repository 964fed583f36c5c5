// What a compound's draw is for the node that draws it.
#pragma once

#include "balancer/compound/render_context.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// As the compounds say it, all above included: in whole pixels of the channel it would differ between neighbours of different sizes.
[[nodiscard]] Zoom zoomOf(const config::ResolvedConfig& config, compound::Index compound);

// A zoom above kMostZoom is that. Which of how many ranges it is, who has all of them says.
[[nodiscard]] RenderPass passOf(const config::ResolvedConfig& config, const compound::RenderContext& context);

} // namespace mural
