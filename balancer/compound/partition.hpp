// Partition of overlapping rectangles into disjoint cells, each covered by one set of rectangles.
#pragma once

#include <vector>

#include "common/geometry/viewport.hpp"

namespace mural::compound {

struct Rect {
    int of = 0; // owner; several pieces may have the same owner
    Viewport area;
};

struct Cell {
    Viewport area;
    std::vector<int> of; // owners of the pieces that cover the cell, unique, in the order of the pieces
};

// Returns a disjoint partition of the union of all pieces. Adjacent cells with equal owners are merged where the result
// is a rectangle, columns first, then rows. Edges closer than `epsilon` are equal.
std::vector<Cell> cellsOf(const std::vector<Rect>& pieces, double epsilon = 1e-7);

} // namespace mural::compound
