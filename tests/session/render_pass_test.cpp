// The render passes of a frame: eyes, samples, kernels, turns.
#include "nodes/session/render_pass.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace mural {
namespace {

PassCounts counted(StereoMode stereo, int kernelWidth, int kernelHeight, int samples, int period) {
    return {stereo, kernelWidth, kernelHeight, samples, period};
}

TEST(RenderPass, isOnePlainPassByDefault) {
    EXPECT_EQ(passesOf({}), std::vector<RenderPass>{RenderPass{}});
    EXPECT_EQ(picturesOf({}), 1);
    EXPECT_EQ(describe({}), "");
}

TEST(RenderPass, coversEveryCombinationOnce) {
    const PassCounts counts = counted(StereoMode::Anaglyph, 3, 2, 5, 4);
    const std::vector<RenderPass> passes = passesOf(counts);
    EXPECT_EQ(passes.size(), 2u * 3 * 2 * 5 * 4);
    EXPECT_EQ(picturesOf(counts), 2 * 3 * 2 * 5);
    std::set<std::string> names;
    for (const RenderPass& p : passes) names.insert(describe(p));
    EXPECT_EQ(names.size(), passes.size());
}

TEST(RenderPass, ordersByEyeRowColumnSampleTurn) {
    const std::vector<RenderPass> passes = passesOf(counted(StereoMode::SideBySide, 2, 2, 2, 2));
    EXPECT_EQ(passes[1].phase, 1);
    EXPECT_EQ(passes[2].sample, 1);
    EXPECT_EQ(passes[4].kernelX, 1);
    EXPECT_EQ(passes[8].kernelY, 1);
    EXPECT_EQ(passes[0].eye, Eye::Left);
    EXPECT_EQ(passes[16].eye, Eye::Right);
}

TEST(RenderPass, combinesTurnsIntoOnePicture) {
    const PassCounts counts = counted(StereoMode::TopBottom, 2, 3, 2, 3);
    const std::vector<RenderPass> passes = passesOf(counts);
    for (size_t i = 0; i < passes.size(); ++i) EXPECT_EQ(pictureOf(counts, passes[i]), static_cast<int>(i) / 3);
}

TEST(RenderPass, makesASingleEyeTheFirstPicture) {
    for (const StereoMode mode : {StereoMode::Left, StereoMode::Right}) {
        const PassCounts counts = counted(mode, 1, 1, 2, 1);
        EXPECT_EQ(picturesOf(counts), 2);
        for (const RenderPass& p : passesOf(counts)) {
            EXPECT_EQ(p.eye, mode == StereoMode::Left ? Eye::Left : Eye::Right);
            EXPECT_EQ(pictureOf(counts, p), p.sample);
        }
    }
}

TEST(RenderPass, placesSamplesAroundThePixelCentre) {
    EXPECT_EQ(jitterOf(0, 1), (std::array<double, 2>{0, 0}));
    for (int n = 2; n <= 256; ++n) {
        double x = 0, y = 0;
        std::set<std::array<double, 2>> places;
        for (int i = 0; i < n; ++i) {
            const auto at = jitterOf(i, n);
            EXPECT_LT(std::fabs(at[0]), 0.5) << i << " of " << n;
            EXPECT_LT(std::fabs(at[1]), 0.5) << i << " of " << n;
            x += at[0];
            y += at[1];
            places.insert(at);
        }
        EXPECT_NEAR(x, 0, 1e-12 * n) << n;
        EXPECT_NEAR(y, 0, 1e-12 * n) << n;
        EXPECT_EQ(places.size(), static_cast<size_t>(n));
    }
}

TEST(RenderPass, spreadsSamplesEvenly) {
    for (const int n : {2, 3, 5, 16, 61}) { // each row and column of an n x n grid has one sample
        std::set<int> columns, rows;
        for (int i = 0; i < n; ++i) {
            const auto at = jitterOf(i, n);
            columns.insert(static_cast<int>(std::floor((at[0] + 0.5) * n)));
            rows.insert(static_cast<int>(std::floor((at[1] + 0.5) * n)));
        }
        EXPECT_EQ(columns.size(), static_cast<size_t>(n));
        EXPECT_EQ(rows.size(), static_cast<size_t>(n));
    }
    EXPECT_EQ(jitterOf(1, 4), (std::array<double, 2>{-0.125, 0.125})) << "radical inverses 0, 1/2, 1/4, 3/4";
}

} // namespace
} // namespace mural
