#include "balancer/equalizers/random_areas.hpp"

#include <algorithm>
#include <numeric>

namespace mural::queue {
namespace {

void cutAtRandom(TileRegion r, std::vector<size_t> nodes, std::mt19937& random, std::vector<TileRegion>& out) {
    if (nodes.size() == 1) {
        out[nodes.front()] = r;
        return;
    }
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<uint32_t>(n)); };
    const bool columns = r.rows < 2 || (r.columns > 1 && below(2) == 0);
    std::shuffle(nodes.begin(), nodes.end(), random);
    const int length = columns ? r.columns : r.rows, across = columns ? r.rows : r.columns;
    const int at = 1 + below(length - 1);
    const int total = static_cast<int>(nodes.size());
    const int fewest = std::max(1, total - (length - at) * across), maximum = std::min(total - 1, at * across);
    const int count = fewest + below(maximum - fewest + 1);
    TileRegion a = r, b = r;
    (columns ? a.columns : a.rows) = at;
    (columns ? b.column : b.row) += at;
    (columns ? b.columns : b.rows) -= at;
    cutAtRandom(a, {nodes.begin(), nodes.begin() + count}, random, out);
    cutAtRandom(b, {nodes.begin() + count, nodes.end()}, random, out);
}

} // namespace

std::vector<TileRegion> randomAreas(int columns, int rows, size_t n, std::mt19937& random) {
    std::vector<size_t> nodes(n);
    std::iota(nodes.begin(), nodes.end(), size_t{0});
    std::vector<TileRegion> areas(n);
    cutAtRandom({0, 0, columns, rows}, std::move(nodes), random, areas);
    return areas;
}

} // namespace mural::queue
