#include "balancer/equalizers/cost_map/density_grid.hpp"

#include <cmath>

namespace mural::balance {

DensityGrid::DensityGrid(size_t columns, size_t rows)
    : columns_(columns), rows_(rows), cells_(columns * rows, 1), sums_((columns + 1) * (rows + 1), 0) {
    sum();
}

void DensityGrid::setCells(const std::vector<float>& cells) {
    cells_.assign(cells.begin(), cells.end());
    sum();
}

void DensityGrid::sum() {
    const size_t width = columns_ + 1;
    for (size_t row = 0; row < rows_; ++row) {
        double line = 0;
        const double* cells = cells_.data() + row * columns_;
        const double* under = sums_.data() + row * width;
        double* out = sums_.data() + (row + 1) * width;
        for (size_t column = 0; column < columns_; ++column) {
            line += cells[column];
            out[column + 1] = under[column + 1] + line;
        }
    }
}

double DensityGrid::below(double x, double y) const {
    const double cx = std::clamp(x, 0., static_cast<double>(columns_));
    const double cy = std::clamp(y, 0., static_cast<double>(rows_));
    const size_t column = std::min(static_cast<size_t>(cx), columns_ - 1);
    const size_t row = std::min(static_cast<size_t>(cy), rows_ - 1);
    const double fx = cx - static_cast<double>(column), fy = cy - static_cast<double>(row);
    const double* low = sums_.data() + row * (columns_ + 1) + column;
    const double* high = low + columns_ + 1;
    return (1 - fy) * ((1 - fx) * low[0] + fx * low[1]) + fy * ((1 - fx) * high[0] + fx * high[1]);
}

double DensityGrid::of(const Viewport& part) const {
    const auto w = static_cast<double>(columns_), h = static_cast<double>(rows_);
    return between(part.x * w, (part.x + part.w) * w, part.y * h, (part.y + part.h) * h);
}

double DensityGrid::cutOf(const Part& part, Axis axis, double share) const {
    const bool isY = axis == Axis::Y;
    const auto w = static_cast<double>(columns_), h = static_cast<double>(rows_);
    Viewport v = part.viewport;
    if (axis == Axis::Range) v = {part.range.start, 0, part.range.end - part.range.start, 1};
    const double x0 = v.x * w, x1 = (v.x + v.w) * w, y0 = v.y * h, y1 = (v.y + v.h) * h;
    const double from = isY ? y0 : x0, to = isY ? y1 : x1;
    const auto line = [&](double place) {
        return isY ? below(x1, place) - below(x0, place) : below(place, y1) - below(place, y0);
    };
    const double before = line(from);
    const auto until = [&](double place) { return line(place) - before; };
    const double all = until(to), target = all * share;
    if (!(all > 0) || !(to > from)) return share;
    // The first edge of cells within the part at which the target is reached.
    auto first = static_cast<long>(std::floor(from)) + 1, end = static_cast<long>(std::ceil(to));
    while (first < end) {
        const long middle = (first + end) / 2;
        if (until(static_cast<double>(middle)) < target)
            first = middle + 1;
        else
            end = middle;
    }
    const double low = std::max(from, static_cast<double>(first - 1)), high = std::min(to, static_cast<double>(first));
    const double lowCost = until(low), highCost = until(high);
    const double inside = highCost > lowCost ? (target - lowCost) / (highCost - lowCost) : .5;
    return std::clamp((low + (high - low) * inside - from) / (to - from), 0., 1.);
}

void DensityGrid::scale(const Viewport& part, double factor) {
    const auto w = static_cast<double>(columns_), h = static_cast<double>(rows_);
    const double x0 = std::max(0., part.x * w), x1 = std::min(w, (part.x + part.w) * w);
    const double y0 = std::max(0., part.y * h), y1 = std::min(h, (part.y + part.h) * h);
    if (!(x1 > x0) || !(y1 > y0)) return;
    // Only the first and the last column can be within the part in part.
    const auto first = static_cast<size_t>(x0), last = static_cast<size_t>(std::ceil(x1)) - 1;
    const auto insideOf = [&](size_t column) {
        const auto x = static_cast<double>(column);
        return std::min(x1, x + 1) - std::max(x0, x);
    };
    const double inFirst = insideOf(first), inLast = insideOf(last);
    for (auto row = static_cast<size_t>(y0); static_cast<double>(row) < y1; ++row) {
        const auto y = static_cast<double>(row);
        const double change = (factor - 1) * (std::min(y1, y + 1) - std::max(y0, y));
        double* cells = cells_.data() + row * columns_;
        cells[first] *= 1 + change * inFirst;
        for (size_t column = first + 1; column < last; ++column) cells[column] *= 1 + change;
        if (last > first) cells[last] *= 1 + change * inLast;
    }
}

void DensityGrid::scaleAll(double factor) {
    for (double& cell : cells_) cell *= factor;
}

void DensityGrid::smooth(const Viewport& part, double weight) {
    const auto cellsOf = [](double from, double size, size_t count) {
        const double most = static_cast<double>(count);
        const auto first = static_cast<long>(std::clamp(std::round(from * most), 0., most));
        return std::pair(first, static_cast<long>(std::clamp(std::round((from + size) * most), 0., most)));
    };
    const auto [x0, x1] = cellsOf(part.x, part.w, columns_);
    const auto [y0, y1] = cellsOf(part.y, part.h, rows_);
    const long reachX = (x1 - x0) / 2, reachY = (y1 - y0) / 2;
    const auto columns = static_cast<long>(columns_), rows = static_cast<long>(rows_);
    for (long y = y0; y < y1; ++y) {
        const long low = std::max(0L, y - reachY), high = std::min(rows, y + reachY + 1);
        const double* under = sums_.data() + low * (columns + 1);
        const double* over = sums_.data() + high * (columns + 1);
        double* cells = cells_.data() + y * columns;
        for (long x = x0; x < x1; ++x) {
            const long left = std::max(0L, x - reachX), right = std::min(columns, x + reachX + 1);
            const double sum = over[right] - over[left] - under[right] + under[left];
            const double mean = std::max(0., sum) / static_cast<double>((right - left) * (high - low));
            cells[x] += weight * (mean - cells[x]);
        }
    }
}

void DensityGrid::raise(double fraction) {
    // Four sums, because each addition waits for the one before.
    double sums[4] = {};
    const size_t quads = cells_.size() / 4 * 4;
    for (size_t i = 0; i < quads; i += 4)
        for (size_t k = 0; k < 4; ++k) sums[k] += cells_[i + k];
    double all = sums[0] + sums[1] + sums[2] + sums[3];
    for (size_t i = quads; i < cells_.size(); ++i) all += cells_[i];
    const double least = all * fraction / static_cast<double>(cells_.size());
    for (double& cell : cells_) cell = std::max(cell, least);
}

} // namespace mural::balance
