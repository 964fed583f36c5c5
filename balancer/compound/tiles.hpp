// Pictures cut into pieces that whoever is free takes from a queue.
#pragma once

#include "balancer/compound/frame_plan.hpp"

namespace mural::compound {

// Rows from below, each in the other direction than the one before, so that a piece lies beside the one before it.
// Ranges are cut in their order. Sizes that would give more than 65536 pieces are doubled until they do not.
std::vector<PlannedTile> tilesOf(const PixelViewport& area, const config::PixelsOrRange& size);

// What a worker draws for one piece of the context that its queue divides.
RenderContext contextOfTile(const RenderContext& worker, const RenderContext& divided, const PlannedTile& tile);

} // namespace mural::compound
