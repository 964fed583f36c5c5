// The cost map: its grid, the watch for changes, released helpers.
#include <gtest/gtest.h>
#include <random>

#include "balancer/equalizers/cost_map/cost_map_equalizer.hpp"
#include "tests/balancer/divided_picture.hpp"

namespace mural::balance {
namespace {

using testing::balanceOf;
using testing::DividedPicture;
using testing::problemOfParts;
using testing::rightHeavy;

DensityGrid randomGrid(size_t columns, size_t rows, uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<float> cells(columns * rows);
    for (float& c : cells) c = static_cast<float>(random() % 1000) / 100;
    DensityGrid grid(columns, rows);
    grid.setCells(cells);
    return grid;
}

TEST(DensityGrid, sumsFractionsOfCells) {
    const DensityGrid grid = randomGrid(7, 5, 1);
    std::mt19937 random(2);
    std::uniform_real_distribution<> any(0, 1);
    for (int round = 0; round < 200; ++round) {
        const double x = any(random), y = any(random);
        const Viewport part{x, y, (1 - x) * any(random), (1 - y) * any(random)};
        double sum = 0;
        for (int row = 0; row < 5; ++row)
            for (int column = 0; column < 7; ++column) {
                const Viewport common = intersect(part, Viewport{column / 7., row / 5., 1 / 7., 1 / 5.});
                if (!common.empty())
                    sum += grid.cells()[static_cast<size_t>(row * 7 + column)] * common.w * common.h * 35;
            }
        EXPECT_NEAR(grid.of(part), sum, 1e-6);
    }
}

TEST(DensityGrid, cutsWhereTheShareIsReached) {
    const DensityGrid grid = randomGrid(40, 30, 3);
    std::mt19937 random(4);
    std::uniform_real_distribution<> any(0.05, .95);
    for (int round = 0; round < 300; ++round) {
        const double x = any(random) / 2, y = any(random) / 2, share = any(random);
        const Part part{{x, y, (1 - x) * any(random), (1 - y) * any(random)}, {x, x + (1 - x) * any(random)}};
        for (const Axis axis : {Axis::X, Axis::Y}) {
            const double at = grid.cutOf(part, axis, share);
            EXPECT_NEAR(grid.of(cutPart(part, axis, at).first.viewport), share * grid.of(part.viewport), 1e-6);
        }
    }
}

TEST(ChangeWatch, findsChangesAndKeepsQuietInNoise) {
    std::mt19937 random(7);
    std::normal_distribution<> noise(1, .03);
    int alarms = 0;
    for (int run = 0; run < 40; ++run) {
        ChangeWatch watch;
        std::vector<double> times(64);
        for (int f = 0; f < 100; ++f) {
            for (double& t : times) t = noise(random);
            alarms += watch.add(times);
        }
        EXPECT_NEAR(watch.noise(), .03, .006);
        int frames = 0;
        for (bool isFound = false; !isFound && frames < 20; ++frames) {
            for (double& t : times) t = noise(random);
            times[5] *= 1.2;
            isFound = watch.add(times);
        }
        EXPECT_LE(frames, 4);
    }
    EXPECT_LE(alarms, 1); // of 4000 frames
}

TEST(ChangeWatch, ignoresACommonFactor) {
    ChangeWatch watch;
    std::vector<double> times{1, 2, 3, 4};
    for (int f = 0; f < 10; ++f) EXPECT_FALSE(watch.add(times));
    for (double& t : times) t *= 3;
    for (int f = 0; f < 10; ++f) EXPECT_FALSE(watch.add(times));
}

struct Helpers {
    DividedPicture picture{16, SplitMode::TwoD};
    CostMapEqualizer equalizer{"map", picture.config(), picture.root(), SplitMode::TwoD};
    double work = .016, assembly = .001; // per helper

    size_t run(int frames) {
        size_t helpers = 0;
        for (int f = 0; f < frames; ++f) {
            picture.update(equalizer);
            FrameStatistics statistics =
                picture.draw([&](const LeafStatistics& leaf) { return work * leaf.viewport.w * leaf.viewport.h; });
            const Index destination = picture.config().compounds[at(picture.root())].destination;
            helpers = 0;
            for (const LeafStatistics& leaf : statistics.leaves) helpers += leaf.compound != picture.children()[0];
            statistics.assemblies.push_back({destination, assembly * static_cast<double>(helpers)});
            equalizer.observe(statistics);
            EXPECT_EQ(problemOfParts(picture.children(), SplitMode::TwoD, picture.states()), "");
        }
        return helpers;
    }
};

TEST(CostMapEqualizer, releasesHelpersThatCostMoreThanTheySaveAndTakesThemBack) {
    Helpers h;
    EXPECT_LT(h.run(60), 8u); // the sum of 16 ms and 1 ms per helper is best with few
    h.work = 1;
    EXPECT_EQ(h.run(60), 15u);
    h.work = .016;
    EXPECT_LT(h.run(80), 8u);
}

TEST(CostMapEqualizer, doesNotReleaseHelpersBackAndForth) {
    Helpers h;
    std::mt19937 random(1);
    h.run(60);
    size_t changes = 0, before = h.run(1);
    for (int f = 0; f < 200; ++f) {
        h.work = .016 * std::uniform_real_distribution<>(.97, 1.03)(random);
        const size_t now = h.run(1);
        changes += now != before;
        before = now;
    }
    EXPECT_LE(changes, 2u);
}

TEST(CostMapEqualizer, learnsWhichNodeIsSlow) {
    DividedPicture picture(8, SplitMode::TwoD);
    CostMapEqualizer equalizer("map", picture.config(), picture.root(), SplitMode::TwoD);
    int frame = 0;
    picture.run(
        equalizer,
        [&](const LeafStatistics& leaf) {
            const double angle = .3 * (frame++ / 8); // a load that moves
            const double x = .5 + .4 * std::cos(angle) - leaf.viewport.x - leaf.viewport.w / 2;
            const double y = .5 + .4 * std::sin(angle) - leaf.viewport.y - leaf.viewport.h / 2;
            const double cost = leaf.viewport.w * leaf.viewport.h * (.2 + std::exp(-10 * (x * x + y * y)));
            return leaf.compound == picture.children()[5] ? 2 * cost : cost;
        },
        150);
    for (size_t i = 0; i < 8; ++i) EXPECT_LE(equalizer.speedOf(5), equalizer.speedOf(i)) << i;
}

} // namespace
} // namespace mural::balance
