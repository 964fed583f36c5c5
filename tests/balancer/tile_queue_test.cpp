// Assignment of tiles by measured times: invariants of the areas, and convergence.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <string>

#include "balancer/equalizers/random_areas.hpp"
#include "balancer/equalizers/tile_queue.hpp"
#include "tests/sanitized.hpp"

namespace mural::queue {
namespace {

bool same(const std::vector<TileRegion>& a, const std::vector<TileRegion>& b) {
    return tilesMoved(a, b) == 0 && a.size() == b.size();
}

// Checks that areas are disjoint, not empty, within the grid, and cover it.
std::string whatIsWrong(int columns, int rows, const std::vector<TileRegion>& areas) {
    std::vector<int> owners(static_cast<size_t>(columns) * static_cast<size_t>(rows), 0);
    for (const TileRegion& r : areas) {
        if (r.columns < 1 || r.rows < 1) return "an empty area";
        if (r.column < 0 || r.row < 0 || r.column + r.columns > columns || r.row + r.rows > rows)
            return "an area outside of the grid";
        for (int y = r.row; y < r.row + r.rows; ++y)
            for (int x = r.column; x < r.column + r.columns; ++x)
                ++owners[static_cast<size_t>(y) * static_cast<size_t>(columns) + static_cast<size_t>(x)];
    }
    return std::ranges::all_of(owners, [](int n) { return n == 1; }) ? ""
                                                                     : "a tile that nobody, or more than one, draws";
}

// A simulated load and the nodes that process it.
struct Load {
    int columns = 1, rows = 1;
    std::vector<double> tiles;  // work per tile
    std::vector<double> speeds; // of the nodes
    double everywhere = 0;      // work of each node independent of its tiles

    [[nodiscard]] std::vector<double> times(const std::vector<TileRegion>& areas) const {
        std::vector<double> times;
        for (size_t i = 0; i < areas.size(); ++i) {
            const TileRegion& r = areas[i];
            double work = everywhere;
            for (int y = r.row; y < r.row + r.rows; ++y)
                for (int x = r.column; x < r.column + r.columns; ++x)
                    work += tiles[static_cast<size_t>(y) * static_cast<size_t>(columns) + static_cast<size_t>(x)];
            times.push_back(work / speeds[i]);
        }
        return times;
    }
    [[nodiscard]] double longest(const std::vector<TileRegion>& areas) const { return std::ranges::max(times(areas)); }
};

// A load concentrated around one place.
Load withHill(int columns, int rows, size_t nodes, double x, double y, double height) {
    Load load{columns, rows, {}, std::vector<double>(nodes, 1), 0};
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double dx = (column + .5) / columns - x, dy = (row + .5) / rows - y;
            load.tiles.push_back(1 + height * std::exp(-30 * (dx * dx + dy * dy)));
        }
    return load;
}

std::vector<TileRegion> strips(int columns, int n) {
    std::vector<TileRegion> areas;
    for (int i = 0; i < n; ++i) areas.push_back({columns * i / n, 0, columns * (i + 1) / n - columns * i / n, 1});
    return areas;
}

// The lowest maximum time of any strips in this order.
double bestOfStrips(const Load& load) {
    const size_t n = load.speeds.size();
    const auto columns = static_cast<size_t>(load.columns);
    std::vector<double> best(columns + 1, INFINITY);
    best[0] = 0;
    for (size_t node = 0; node < n; ++node) {
        std::vector<double> next(columns + 1, INFINITY);
        for (size_t from = 0; from < columns; ++from) {
            double work = load.everywhere;
            for (size_t to = from + 1; to <= columns; ++to) {
                work += load.tiles[to - 1];
                next[to] = std::min(next[to], std::max(best[from], work / load.speeds[node]));
            }
        }
        best = next;
    }
    return best[columns];
}

struct Course {
    double first = 0, last = 0; // the maximum time
    int moves = 0, lateMoves = 0;
    std::string wrong;
};

Course run(const Load& load, std::vector<TileRegion> areas, int frames, double noise = 0, uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> factor(1 - noise, 1 + noise);
    TileQueue queue(load.columns, load.rows, std::move(areas));
    Course result;
    result.first = load.longest(queue.areas());
    for (int frame = 0; frame < frames && result.wrong.empty(); ++frame) {
        auto times = load.times(queue.areas());
        for (double& time : times) time *= factor(random);
        if (!queue.drawn(times)) continue;
        ++result.moves;
        result.lateMoves += frame >= frames / 2;
        result.wrong = whatIsWrong(load.columns, load.rows, queue.areas());
    }
    result.last = load.longest(queue.areas());
    return result;
}

TEST(DealTiles, coversTheGridOnceForAnyCostsAndCuts) {
    std::mt19937 random(7);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<uint32_t>(n)); };
    for (int round = 0; round < 2000; ++round) {
        const int columns = 1 + below(20), rows = 1 + below(12), n = 1 + below(std::min(columns * rows, 9));
        const auto before = randomAreas(columns, rows, static_cast<size_t>(n), random);
        ASSERT_EQ(whatIsWrong(columns, rows, before), "");
        TileCosts costs(columns, rows);
        for (const TileRegion& r :
             randomAreas(columns, rows, static_cast<size_t>(1 + below(std::min(columns * rows, 12))), random))
            costs.update(r, below(3) == 0 ? 0 : std::pow(10, below(7) - 3));
        const auto after = dealTiles(costs, before);
        ASSERT_EQ(after.size(), before.size());
        ASSERT_EQ(whatIsWrong(columns, rows, after), "")
            << columns << "x" << rows << " for " << n << ", round " << round;
        ASSERT_TRUE(same(dealTiles(costs, before), after)) << "not the same twice";
        ASSERT_EQ(whatIsWrong(columns, rows, dealTiles(costs, after)), "") << "areas that it has made itself";
    }
}

TEST(DealTiles, givesEqualAreasForEqualCosts) {
    const TileCosts costs(16, 1);
    const auto dealt = dealTiles(costs, {{0, 0, 1, 1}, {1, 0, 2, 1}, {3, 0, 3, 1}, {6, 0, 10, 1}});
    for (const TileRegion& r : dealt) EXPECT_EQ(r.columns, 4);
}

TEST(DealTiles, keepsCutsThatFitTheCosts) {
    TileCosts costs(12, 6);
    const std::vector<TileRegion> areas{{0, 0, 3, 6}, {3, 0, 9, 2}, {3, 2, 9, 4}};
    for (const TileRegion& r : areas) costs.update(r, 5);
    EXPECT_TRUE(same(dealTiles(costs, areas), areas));
}

TEST(TileCosts, keepsTheSharesWithinARegion) {
    TileCosts costs(4, 2);
    costs.update({0, 0, 1, 1}, 3);
    costs.update({0, 0, 2, 1}, 8);
    EXPECT_DOUBLE_EQ(costs.of({0, 0, 1, 1}), 6);
    EXPECT_DOUBLE_EQ(costs.of({1, 0, 1, 1}), 2);
    EXPECT_DOUBLE_EQ(costs.of({0, 0, 4, 2}), 8 + 6);
}

// For a peak at any place, with strips and rectangles, the maximum time approaches an equal share.
TEST(TileQueue, approachesTheOptimumOnUnevenLoads) {
    for (const double height : {0., 5., 50.})
        for (const double x : {0.05, 0.3, 0.5, 0.95})
            for (const int n : {2, 3, 5}) {
                const Load load = withHill(64, 1, static_cast<size_t>(n), x, 0.5, height);
                const Course strip = run(load, strips(64, n), 300);
                ASSERT_EQ(strip.wrong, "");
                EXPECT_LE(strip.last, 1.25 * bestOfStrips(load))
                    << n << " strips, hill of " << height << " at " << x << ", from " << strip.first;
                std::mt19937 random(static_cast<uint32_t>(n));
                const Load wide = withHill(40, 30, static_cast<size_t>(n), x, 0.8, height);
                const Course rectangles = run(wide, randomAreas(40, 30, static_cast<size_t>(n), random), 300);
                double all = 0;
                for (const double tile : wide.tiles) all += tile;
                ASSERT_EQ(rectangles.wrong, "");
                EXPECT_LE(rectangles.last, 1.25 * all / n)
                    << n << " rectangles, hill of " << height << " at " << x << ", from " << rectangles.first;
            }
}

TEST(TileQueue, assignsMoreToFasterNodes) {
    for (const std::vector<double>& speeds : {std::vector<double>{1, 3}, {4, 1, 2}, {1, 1, 1, 5}})
        for (const double everywhere : {0., 40.}) {
            Load load = withHill(64, 1, speeds.size(), 0.2, 0.5, 4);
            load.speeds = speeds;
            load.everywhere = everywhere;
            const Course got = run(load, strips(64, static_cast<int>(speeds.size())), 400);
            ASSERT_EQ(got.wrong, "");
            EXPECT_LE(got.last, 1.3 * bestOfStrips(load)) << "from " << got.first;
            EXPECT_LT(got.last, got.first);
        }
}

// A tile that costs more than all others together cannot be divided: its node ends up with few others.
TEST(TileQueue, isolatesOneExpensiveTile) {
    for (int hot = 0; hot < 32; ++hot) {
        Load load{32, 1, std::vector<double>(32, 1), {1, 1}, 0};
        load.tiles[static_cast<size_t>(hot)] = 100;
        const Course got = run(load, strips(32, 2), 400);
        EXPECT_LE(got.last, 1.15 * bestOfStrips(load)) << "hot tile " << hot;
    }
}

TEST(TileQueue, settlesOnAConstantLoad) {
    std::mt19937 random(3);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<uint32_t>(n)); };
    for (int round = 0; round < static_cast<int>(mural::testing::rounds(300)); ++round) {
        const int columns = 2 + below(30), rows = 1 + below(20), n = std::min(columns * rows, 2 + below(6));
        Load load{columns, rows, {}, {}, below(3) == 0 ? 5. * columns : 0.};
        for (int i = 0; i < columns * rows; ++i) load.tiles.push_back(below(10) == 0 ? 100 : 1 + below(5));
        for (int i = 0; i < n; ++i) load.speeds.push_back(1 + below(4));
        const Course got = run(load, randomAreas(columns, rows, static_cast<size_t>(n), random), 400);
        ASSERT_EQ(got.wrong, "");
        EXPECT_EQ(got.lateMoves, 0) << "round " << round << ": " << got.moves << " moves";
        EXPECT_LE(got.last, got.first * 1.0001) << "round " << round;
    }
}

TEST(TileQueue, movesLittleForNoise) {
    int late = 0;
    for (uint32_t seed = 0; seed < 50; ++seed)
        late += run(withHill(64, 1, 3, 0.3, 0.5, 20), strips(64, 3), 600, 0.03, seed).lateMoves;
    EXPECT_LE(late, 10) << "in 15000 frames";
}

TEST(TileQueue, followsAChangingLoad) {
    TileQueue queue(64, 1, strips(64, 2));
    Load load = withHill(64, 1, 2, 0.1, 0.5, 40);
    for (int frame = 0; frame < 200; ++frame) queue.drawn(load.times(queue.areas()));
    EXPECT_LE(load.longest(queue.areas()), 1.25 * bestOfStrips(load));
    load = withHill(64, 1, 2, 0.9, 0.5, 40);
    for (int frame = 0; frame < 200; ++frame) queue.drawn(load.times(queue.areas()));
    EXPECT_LE(load.longest(queue.areas()), 1.25 * bestOfStrips(load)) << "the hill stands elsewhere";
}

TEST(TileQueue, ignoresInvalidTimes) {
    TileQueue queue(8, 1, strips(8, 2));
    for (const auto& times : {std::vector<double>{0, 0}, {1}, {1, -1}, {NAN, 1}, {INFINITY, 1}})
        for (int i = 0; i < 10; ++i) EXPECT_FALSE(queue.drawn(times));
    TileQueue alone(8, 1, strips(8, 1));
    EXPECT_FALSE(alone.drawn({5}));
    EXPECT_FALSE(alone.drawn({5}));
}

TEST(TilesMoved, countsTilesWithANewNode) {
    EXPECT_EQ(tilesMoved(strips(8, 2), strips(8, 2)), 0);
    EXPECT_EQ(tilesMoved({{0, 0, 4, 2}, {4, 0, 4, 2}}, {{0, 0, 3, 2}, {3, 0, 5, 2}}), 2);
    EXPECT_EQ(tilesMoved({{0, 0, 4, 2}, {4, 0, 4, 2}}, {{4, 0, 4, 2}, {0, 0, 4, 2}}), 16);
}

} // namespace
} // namespace mural::queue
