#include "balancer/compound/partition.hpp"

#include <algorithm>

namespace mural::compound {

namespace {

std::vector<double> edgesOf(const std::vector<Rect>& pieces, bool columns, double epsilon) {
    std::vector<double> all, edges;
    for (const Rect& p : pieces) {
        all.push_back(columns ? p.area.x : p.area.y);
        all.push_back(columns ? p.area.x + p.area.w : p.area.y + p.area.h);
    }
    std::sort(all.begin(), all.end());
    for (const double e : all)
        if (edges.empty() || e - edges.back() > epsilon) edges.push_back(e);
    return edges;
}

size_t indexOf(const std::vector<double>& edges, double edge, double epsilon) {
    return static_cast<size_t>(std::lower_bound(edges.begin(), edges.end(), edge - 2 * epsilon) - edges.begin());
}

} // namespace

std::vector<Cell> cellsOf(const std::vector<Rect>& pieces, double epsilon) {
    const std::vector<double> xs = edgesOf(pieces, true, epsilon), ys = edgesOf(pieces, false, epsilon);
    if (xs.size() < 2 || ys.size() < 2) return {};
    const size_t columns = xs.size() - 1, rows = ys.size() - 1;
    std::vector<std::vector<int>> grid(columns * rows);
    for (const Rect& p : pieces) {
        const size_t x0 = indexOf(xs, p.area.x, epsilon), x1 = indexOf(xs, p.area.x + p.area.w, epsilon);
        const size_t y0 = indexOf(ys, p.area.y, epsilon), y1 = indexOf(ys, p.area.y + p.area.h, epsilon);
        for (size_t y = y0; y < y1; ++y)
            for (size_t x = x0; x < x1; ++x) {
                std::vector<int>& there = grid[y * columns + x];
                if (std::find(there.begin(), there.end(), p.of) == there.end()) there.push_back(p.of);
            }
    }
    for (auto& there : grid) std::sort(there.begin(), there.end()); // order independent of the order of the pieces

    // Merge cells of a row first, then extend each run upwards while the next row has the same run.
    std::vector<bool> taken(grid.size(), false);
    std::vector<Cell> cells;
    for (size_t y = 0; y < rows; ++y)
        for (size_t x = 0; x < columns; ++x) {
            const std::vector<int>& there = grid[y * columns + x];
            if (taken[y * columns + x] || there.empty()) continue;
            size_t x1 = x + 1, y1 = y + 1;
            while (x1 < columns && !taken[y * columns + x1] && grid[y * columns + x1] == there) ++x1;
            const auto goesOn = [&](size_t row) {
                for (size_t i = x; i < x1; ++i)
                    if (taken[row * columns + i] || grid[row * columns + i] != there) return false;
                return true;
            };
            while (y1 < rows && goesOn(y1)) ++y1;
            for (size_t row = y; row < y1; ++row)
                for (size_t i = x; i < x1; ++i) taken[row * columns + i] = true;
            cells.push_back({{xs[x], ys[y], xs[x1] - xs[x], ys[y1] - ys[y]}, there});
        }
    return cells;
}

} // namespace mural::compound
