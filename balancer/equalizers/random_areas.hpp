// Random partitions of a tile grid by cuts, for fault injection and tests. Pure.
#pragma once

#include <random>
#include <vector>

#include "common/geometry/tile_grid.hpp"

namespace mural::queue {

// Returns areas that are valid for dealTiles(). Requires 1 <= n <= columns * rows.
std::vector<TileRegion> randomAreas(int columns, int rows, size_t n, std::mt19937& random);

} // namespace mural::queue
