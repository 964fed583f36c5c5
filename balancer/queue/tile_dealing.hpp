// Tiles of a picture, dealt to nodes by what they cost. Pure.
//
// A node draws one rectangle of tiles, for one rectangle is one scissor: a run of tiles whose union is none would have to be
// drawn once for each piece. The rectangles come from cuts through the whole, then through each half and so on. Which node
// lies on which side of which cut stays as it is; the cuts move.
#pragma once

#include <vector>

#include "common/tile_grid.hpp"

namespace mural::queue {

// What each tile takes its node, in any unit of time.
class TileCosts {
public:
    TileCosts(int columns, int rows); // all the same
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] double of(const TileRegion& region) const;
    // The tiles of this region take so much together. Among them the shares stay.
    void learn(const TileRegion& region, double time);

private:
    [[nodiscard]] size_t at(int column, int row) const { return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column); }
    [[nodiscard]] double below(int column, int row) const; // of all tiles left of the one and below the other
    void sum();

    int columns_, rows_;
    std::vector<double> tiles_; // rows from the lowest
    std::vector<double> sums_;  // of all below and left, one more in each direction
};

// `areas`: disjoint, none empty, covering the grid, made by such cuts. So are those that come back, in the same order; each cut
// divides what lies on its two sides as evenly by cost as tiles allow. The same costs and areas give the same areas.
std::vector<TileRegion> dealTiles(const TileCosts& costs, const std::vector<TileRegion>& areas);

} // namespace mural::queue
