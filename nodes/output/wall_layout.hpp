// The windows of tiles of a wall: one for each, numbered in reading order.
#pragma once

#include <vector>

#include "common/tile_grid.hpp"
#include "nodes/output/wall_windows.hpp"

namespace mural {

// Of the region's tiles, row by row from the lowest; the picture has this size.
[[nodiscard]] std::vector<TileWindow> windowsOfTiles(const TileGrid& grid, const TileRegion& region, int width, int height);

} // namespace mural
