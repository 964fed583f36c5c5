// Divides a grid of tiles among n render nodes, as n rectangles of whole tiles. Pure.
#pragma once

#include <vector>

#include "common/geometry/tile_grid.hpp"

namespace mural {

// Recursive bisection: minimises, over all cuts and divisions of the nodes, the larger average number of tiles per
// node. The regions are disjoint and cover the grid. Requires 1 ≤ n ≤ columns * rows.
std::vector<TileRegion> splitGrid(int columns, int rows, int n);

} // namespace mural
