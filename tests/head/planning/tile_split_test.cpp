// Division of a tile grid among nodes.
#include "nodes/head/planning/tile_split.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace mural {
namespace {

// How often each tile is covered, and the maximum number of tiles per region.
struct Coverage {
    bool exact = true;
    int maximum = 0;
};

Coverage coverageOf(int columns, int rows, const std::vector<TileRegion>& regions) {
    std::vector<int> covered(static_cast<size_t>(columns * rows), 0);
    Coverage result;
    for (const TileRegion& r : regions) {
        if (r.columns < 1 || r.rows < 1 || r.column < 0 || r.row < 0 || r.column + r.columns > columns ||
            r.row + r.rows > rows)
            return {false, 0};
        result.maximum = std::max(result.maximum, r.columns * r.rows);
        for (int y = r.row; y < r.row + r.rows; ++y)
            for (int x = r.column; x < r.column + r.columns; ++x) ++covered[static_cast<size_t>(y * columns + x)];
    }
    result.exact = std::ranges::all_of(covered, [](int n) { return n == 1; });
    return result;
}

TEST(SplitGrid, coversEveryTileOnceForAnyNumberOfNodes) {
    for (int columns = 1; columns <= 9; ++columns)
        for (int rows = 1; rows <= 9; ++rows)
            for (int n = 1; n <= columns * rows; ++n) {
                const auto regions = splitGrid(columns, rows, n);
                ASSERT_EQ(regions.size(), static_cast<size_t>(n));
                const Coverage coverage = coverageOf(columns, rows, regions);
                ASSERT_TRUE(coverage.exact) << columns << 'x' << rows << " over " << n;
                // Rectangles of whole tiles are uneven in general; twice the equal share is the bound.
                const int even = (columns * rows + n - 1) / n;
                ASSERT_LE(coverage.maximum, 2 * even) << columns << 'x' << rows << " over " << n;
            }
}

TEST(SplitGrid, dividesEquallyWherePossible) {
    const int cases[][4] = {{2, 2, 4, 1},  {4, 4, 4, 4}, {4, 2, 2, 4},  {7, 5, 35, 1}, {6, 1, 3, 2},
                            {8, 8, 16, 4}, {5, 1, 5, 1}, {7, 5, 4, 10}, {3, 3, 9, 1},  {1, 13, 13, 1}};
    for (const auto& [columns, rows, n, maximum] : cases)
        EXPECT_EQ(coverageOf(columns, rows, splitGrid(columns, rows, n)).maximum, maximum)
            << columns << 'x' << rows << " over " << n;
}

TEST(SplitGrid, putsTheLowerLeftTileIntoTheFirstRegion) {
    const auto regions = splitGrid(7, 5, 4);
    EXPECT_EQ(regions[0].column, 0);
    EXPECT_EQ(regions[0].row, 0);
}

TEST(SplitGrid, supportsLargeWallsAndPrimeCounts) {
    for (const int n : {97, 211, 509, 1021, 1024}) {
        const auto regions = splitGrid(32, 32, n);
        const Coverage coverage = coverageOf(32, 32, regions);
        EXPECT_TRUE(coverage.exact);
        EXPECT_LE(coverage.maximum, 2 * ((1024 + n - 1) / n));
    }
}

} // namespace
} // namespace mural
