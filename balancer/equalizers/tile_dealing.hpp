// Assigns tiles of a picture to nodes by cost. Pure.
//
// A node draws one rectangle of tiles, because one rectangle is one scissor: a non-rectangular set would need one draw
// per rectangle. The rectangles result from recursive bisection of the grid. The side of each cut on which a node lies
// never changes; only the cuts move.
#pragma once

#include <vector>

#include "common/geometry/tile_grid.hpp"

namespace mural::queue {

// Cost of each tile for its node, in any unit of time.
class TileCosts {
public:
    TileCosts(int columns, int rows); // all costs equal
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] double of(const TileRegion& region) const;
    // Scales the costs of this region's tiles to the total `time`. Their proportions stay.
    void update(const TileRegion& region, double time);

private:
    [[nodiscard]] size_t at(int column, int row) const {
        return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
    }
    [[nodiscard]] double below(int column, int row) const; // sum over all tiles left of `column` and below `row`
    void sum();

    int columns_, rows_;
    std::vector<double> tiles_; // row-major, lowest row first
    std::vector<double> sums_;  // summed-area table, one larger in each direction
};

// Returns areas in which each cut balances the costs of its two sides as evenly as whole tiles allow. Requires `areas`
// to be disjoint, non-empty, to cover the grid, and to result from such cuts; the result satisfies the same, in the
// same order. Deterministic.
std::vector<TileRegion> dealTiles(const TileCosts& costs, const std::vector<TileRegion>& areas);

} // namespace mural::queue
