// Division of pictures and ranges into the work items of a queue.
#pragma once

#include "balancer/compound/frame_plan.hpp"

namespace mural::compound {

// Returns the tiles in boustrophedon order, lowest row first, so that consecutive tiles are adjacent. Ranges are
// divided in ascending order. A size that gives more than 65536 items is doubled until it does not.
std::vector<PlannedTile> tilesOf(const PixelViewport& area, const config::PixelsOrRange& size);

// Returns the context in which a worker draws one item of the divided context.
RenderContext contextOfTile(const RenderContext& worker, const RenderContext& divided, const PlannedTile& tile);

} // namespace mural::compound
