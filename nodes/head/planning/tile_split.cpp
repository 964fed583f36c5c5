#include "nodes/head/planning/tile_split.hpp"

#include <algorithm>
#include <cstdlib>

namespace mural {
namespace {

// A cut of the grid: the first `at` columns (or rows) go to `nodes` of the nodes.
struct Cut {
    bool columns = true;
    int at = 0;
    int nodes = 0;
    double load = 0;   // tiles per node on the side with more
    int uneven = 0;    // distance from the middle: among equal cuts the middle one gives squarer parts
    int otherSide = 0; // length of the cut in tiles: short cuts share fewer edges
};

bool better(const Cut& a, const Cut& b) {
    if (a.load != b.load) return a.load < b.load;
    if (a.otherSide != b.otherSide) return a.otherSide < b.otherSide;
    return a.uneven < b.uneven;
}

void weighCuts(bool columns, int length, int across, int n, Cut& best) {
    for (int at = 1; at < length; ++at) {
        const int tilesA = at * across;
        const int tilesB = (length - at) * across;
        const int fewest = std::max(1, n - tilesB);
        const int maximum = std::min(tilesA, n - 1);
        const int share = n * at / length;
        for (int nodes : {share, share + 1}) {
            nodes = std::clamp(nodes, fewest, maximum);
            const double load =
                std::max(static_cast<double>(tilesA) / nodes, static_cast<double>(tilesB) / (n - nodes));
            const Cut cut{columns, at, nodes, load, std::abs(2 * at - length), across};
            if (best.at == 0 || better(cut, best)) best = cut;
        }
    }
}

void split(const TileRegion& r, int n, std::vector<TileRegion>& out) {
    if (n == 1) {
        out.push_back(r);
        return;
    }
    Cut cut;
    weighCuts(true, r.columns, r.rows, n, cut);
    weighCuts(false, r.rows, r.columns, n, cut);
    TileRegion a = r;
    TileRegion b = r;
    if (cut.columns) {
        a.columns = cut.at;
        b.column += cut.at;
        b.columns -= cut.at;
    } else {
        a.rows = cut.at;
        b.row += cut.at;
        b.rows -= cut.at;
    }
    split(a, cut.nodes, out);
    split(b, n - cut.nodes, out);
}

} // namespace

std::vector<TileRegion> splitGrid(int columns, int rows, int n) {
    std::vector<TileRegion> regions;
    split({0, 0, columns, rows}, n, regions);
    return regions;
}

} // namespace mural
