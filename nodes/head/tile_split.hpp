// Which tiles each render node draws: a grid cut into n rectangles of whole tiles. Pure.
#pragma once

#include <vector>

#include "common/tile_grid.hpp"

namespace mural {

// Recursive bisection: every cut and every division of the nodes over its sides is weighed by the
// most tiles that a node of a side gets on average. Regions are disjoint and cover the grid.
// Needs 1 ≤ n ≤ columns * rows.
std::vector<TileRegion> splitGrid(int columns, int rows, int n);

} // namespace mural
