// The windows for the tiles of a wall: one per tile, in reading order.
#pragma once

#include <vector>

#include "common/geometry/tile_grid.hpp"
#include "nodes/output/windows/wall_windows.hpp"

namespace mural {

// The windows of the region's tiles, row by row from the lowest. width, height: of the picture.
[[nodiscard]] std::vector<TileWindow> windowsOfTiles(const TileGrid& grid, const TileRegion& region, int width,
                                                     int height);

} // namespace mural
