// Cost of a picture per cell, or of a range with one row of cells. The cost of a cell is spread evenly over it.
#pragma once

#include <cstddef>
#include <vector>

#include "balancer/equalizers/split/split_tree.hpp"

namespace mural::balance {

class DensityGrid {
public:
    DensityGrid() = default;
    DensityGrid(size_t columns, size_t rows); // all costs 1

    [[nodiscard]] size_t columns() const { return columns_; }
    [[nodiscard]] size_t rows() const { return rows_; }
    [[nodiscard]] const std::vector<double>& cells() const { return cells_; } // row-major, lowest row first
    void setCells(const std::vector<float>& cells);                           // requires columns * rows values

    // Returns the cost of a part. Requires that sum() was called after the last change.
    [[nodiscard]] double of(const Viewport& part) const;
    [[nodiscard]] double of(const Part& part, Axis axis) const {
        return axis == Axis::Range ? of(Viewport{part.range.start, 0, part.range.end - part.range.start, 1})
                                   : of(part.viewport);
    }
    [[nodiscard]] double total() const { return sums_.back(); }
    // Returns the position of the cut, as a fraction of the part, below which the part has `share` of its cost.
    [[nodiscard]] double cutOf(const Part& part, Axis axis, double share) const;

    // Multiplies the cost within the part.
    void scale(const Viewport& part, double factor);
    void scaleAll(double factor);
    // Replaces each cost within the part by a weighted mean of itself (1 - weight) and of a rectangle of the part's
    // size around it (weight). Uses the sums before the change.
    void smooth(const Viewport& part, double weight);
    // Raises costs to a fraction of the mean, so that no part is free.
    void raise(double fraction);
    void sum();

private:
    [[nodiscard]] double below(double x, double y) const; // cost left of x and below y, in cells
    [[nodiscard]] double between(double x0, double x1, double y0, double y1) const {
        return below(x1, y1) - below(x0, y1) - below(x1, y0) + below(x0, y0);
    }

    size_t columns_ = 0, rows_ = 0;
    std::vector<double> cells_;
    std::vector<double> sums_; // summed-area table, one larger in each direction
};

} // namespace mural::balance
