// Any areas that are made by cuts, any node on either side of them: for faults on purpose and tests. Pure.
#pragma once

#include <random>
#include <vector>

#include "common/tile_grid.hpp"

namespace mural::queue {

// As dealTiles() takes them. Needs 1 <= n <= columns * rows.
std::vector<TileRegion> randomAreas(int columns, int rows, size_t n, std::mt19937& random);

} // namespace mural::queue
