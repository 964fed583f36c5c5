#include "balancer/equalizers/tile_dealing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

namespace mural::queue {

TileCosts::TileCosts(int columns, int rows)
    : columns_(columns), rows_(rows), tiles_(static_cast<size_t>(columns) * static_cast<size_t>(rows), 1.0) {
    sum();
}

double TileCosts::below(int column, int row) const {
    return sums_[static_cast<size_t>(row) * static_cast<size_t>(columns_ + 1) + static_cast<size_t>(column)];
}

double TileCosts::of(const TileRegion& r) const {
    return below(r.column + r.columns, r.row + r.rows) - below(r.column, r.row + r.rows) -
           below(r.column + r.columns, r.row) + below(r.column, r.row);
}

void TileCosts::sum() {
    sums_.assign(static_cast<size_t>(columns_ + 1) * static_cast<size_t>(rows_ + 1), 0);
    for (int row = 0; row < rows_; ++row) {
        double before = 0;
        for (int column = 0; column < columns_; ++column) {
            before += tiles_[at(column, row)];
            sums_[static_cast<size_t>(row + 1) * static_cast<size_t>(columns_ + 1) + static_cast<size_t>(column + 1)] =
                below(column + 1, row) + before;
        }
    }
}

void TileCosts::update(const TileRegion& region, double time) {
    constexpr double kMin = 1e-9; // least cost of a tile: zero costs have no proportions
    const double before = of(region);
    const double each = time / (static_cast<double>(region.columns) * region.rows);
    for (int row = region.row; row < region.row + region.rows; ++row)
        for (int column = region.column; column < region.column + region.columns; ++column) {
            double& tile = tiles_[at(column, row)];
            tile = std::max(kMin, before > 0 && std::isfinite(before) ? tile * (time / before) : each);
        }
    sum();
}

namespace {

using Nodes = std::vector<size_t>;

// A cut through the grid that crosses no area, and the nodes on either side.
struct Cut {
    bool columns = true; // true: divides columns; false: rows
    int at = 0;          // first column, or row, after the cut
    Nodes before, behind;
};

struct Size {
    int columns = 1, rows = 1;
};

class Dealer {
public:
    Dealer(const TileCosts& costs, const std::vector<TileRegion>& areas)
        : costs_(costs), areas_(areas), dealt_(areas) {}

    std::vector<TileRegion> deal() {
        Nodes all(areas_.size());
        std::iota(all.begin(), all.end(), size_t{0});
        if (!all.empty()) divide(all, {0, 0, costs_.columns(), costs_.rows()});
        return std::move(dealt_);
    }

private:
    [[nodiscard]] int from(size_t node, bool columns) const { return columns ? areas_[node].column : areas_[node].row; }
    [[nodiscard]] int to(size_t node, bool columns) const {
        return columns ? areas_[node].column + areas_[node].columns : areas_[node].row + areas_[node].rows;
    }

    // Returns the cut with the most balanced number of nodes; columns are preferred to rows.
    [[nodiscard]] Cut cutOf(const Nodes& nodes) const {
        Cut best;
        size_t bestUneven = std::numeric_limits<size_t>::max();
        for (const bool columns : {true, false})
            for (const size_t candidate : nodes) {
                Cut cut{columns, from(candidate, columns), {}, {}};
                const bool crossed = std::ranges::any_of(
                    nodes, [&](size_t n) { return from(n, columns) < cut.at && to(n, columns) > cut.at; });
                if (crossed) continue;
                for (const size_t n : nodes) (from(n, columns) < cut.at ? cut.before : cut.behind).push_back(n);
                if (cut.before.empty()) continue;
                const size_t uneven =
                    std::max(cut.before.size(), cut.behind.size()) - std::min(cut.before.size(), cut.behind.size());
                if (uneven >= bestUneven) continue;
                bestUneven = uneven;
                best = std::move(cut);
            }
        return best;
    }

    // Returns the least number of columns and rows that these nodes need.
    [[nodiscard]] Size minOf(const Nodes& nodes) const {
        if (nodes.size() < 2) return {};
        const Cut cut = cutOf(nodes);
        const Size a = minOf(cut.before), b = minOf(cut.behind);
        return cut.columns ? Size{a.columns + b.columns, std::max(a.rows, b.rows)}
                           : Size{std::max(a.columns, b.columns), a.rows + b.rows};
    }

    static std::pair<TileRegion, TileRegion> halves(const TileRegion& r, bool columns, int length) {
        TileRegion a = r, b = r;
        if (columns) {
            a.columns = length;
            b.column += length;
            b.columns -= length;
        } else {
            a.rows = length;
            b.row += length;
            b.rows -= length;
        }
        return {a, b};
    }

    void divide(const Nodes& nodes, const TileRegion& r) {
        if (nodes.size() < 2) {
            dealt_[nodes.front()] = r;
            return;
        }
        const Cut cut = cutOf(nodes);
        const Size minimum = minOf(cut.before), rest = minOf(cut.behind);
        const int length = cut.columns ? r.columns : r.rows;
        const int first = cut.columns ? minimum.columns : minimum.rows,
                  last = length - (cut.columns ? rest.columns : rest.rows);
        const int now = cut.at - (cut.columns ? r.column : r.row);
        int best = first;
        double bestLoad = std::numeric_limits<double>::infinity();
        for (int at = first; at <= last; ++at) {
            const auto [a, b] = halves(r, cut.columns, at);
            const double load = std::max(costs_.of(a) / static_cast<double>(cut.before.size()),
                                         costs_.of(b) / static_cast<double>(cut.behind.size()));
            const bool nearer = load == bestLoad && std::abs(at - now) < std::abs(best - now);
            if (load < bestLoad || nearer) {
                best = at;
                bestLoad = load;
            }
        }
        const auto [a, b] = halves(r, cut.columns, best);
        divide(cut.before, a);
        divide(cut.behind, b);
    }

    const TileCosts& costs_;
    const std::vector<TileRegion>& areas_;
    std::vector<TileRegion> dealt_;
};

} // namespace

std::vector<TileRegion> dealTiles(const TileCosts& costs, const std::vector<TileRegion>& areas) {
    return Dealer(costs, areas).deal();
}

} // namespace mural::queue
