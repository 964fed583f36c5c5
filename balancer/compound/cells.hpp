// Rectangles that lie over each other, taken apart: where the same ones lie.
#pragma once

#include <vector>

#include "common/viewport.hpp"

namespace mural::compound {

struct Piece {
    int of = 0; // whose it is; several may be of one
    Viewport area;
};

struct Cell {
    Viewport area;
    std::vector<int> of; // who lies there, each once, in the order of the pieces
};

// No two of them have anything in common, and together they are all that the pieces cover; neighbours of which the same ones are there are one
// where that makes a rectangle, from left to right before from bottom to top. Edges that differ by less than `near` are one.
std::vector<Cell> cellsOf(const std::vector<Piece>& pieces, double near = 1e-7);

} // namespace mural::compound
