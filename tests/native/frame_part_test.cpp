#include "native/runtime/frame_part.hpp"

#include <gtest/gtest.h>

namespace mural::native {
namespace {

constexpr int32_t kWidth = 801, kHeight = 603;

FramePart partOf(const PlayerConfig& config, const ViewportAssignment* areas = nullptr, uint32_t frame = 1,
                 int samples = 0) {
    return framePartOf(config, areas, config.pass.share, kWidth, kHeight, frame, samples);
}

TEST(FramePart, tilesCoverThePictureOnce) {
    PlayerConfig config;
    config.grid = {3, 2, 1};
    int64_t pixels = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 2; ++row) {
            config.region = {column, row, 1, 1};
            const FramePart part = partOf(config);
            EXPECT_EQ(part.shown, part.drawn);
            EXPECT_EQ(part.picture, (PixelViewport{0, 0, kWidth, kHeight}));
            EXPECT_EQ(part.surface, part.picture);
            pixels += part.shown.area();
        }
    EXPECT_EQ(pixels, int64_t{kWidth} * kHeight);
}

TEST(FramePart, followsAssignedAreas) {
    PlayerConfig config;
    config.node = 1;
    const ViewportAssignment areas{7, {{0, 0, 0.25, 1}, {0.25, 0, 0.75, 1}}, {}};
    const FramePart part = partOf(config, &areas);
    EXPECT_EQ(part.areas, 7u);
    EXPECT_EQ(part.drawn, (PixelViewport{200, 0, 601, kHeight}));
    EXPECT_NEAR(part.context.part.x, 200.0 / kWidth, 1e-12);
    config.node = 2; // the assignment has no such node
    EXPECT_TRUE(partOf(config, &areas).drawn.empty());
}

TEST(FramePart, letOnlyTheCollectorShowThePicture) {
    PlayerConfig config;
    config.pass.ranges = 2;
    config.pass.share = {0, 0.5};
    FramePart part = partOf(config);
    EXPECT_FALSE(part.shown.empty());
    EXPECT_EQ(part.context.range, (Range{0, 0.5}));
    config.pass.range = 1;
    config.pass.share = {0.5, 1};
    part = partOf(config);
    EXPECT_TRUE(part.shown.empty());
    EXPECT_FALSE(part.drawn.empty());
    EXPECT_EQ(part.context.range, (Range{0.5, 1}));
}

TEST(FramePart, drawsTheFramesOfItsTurn) {
    PlayerConfig config;
    config.pass.period = 3;
    config.pass.phase = 1;
    EXPECT_FALSE(partOf(config, nullptr, 4).drawn.empty());
    EXPECT_TRUE(partOf(config, nullptr, 5).drawn.empty());
    EXPECT_TRUE(partOf(config, nullptr, 5).shown.empty());
}

TEST(FramePart, zoomsOfAssignmentsKeepTheFramebuffer) {
    PlayerConfig config;
    config.movesZoom = true;
    config.pass.zoom = {1, 1};
    const ViewportAssignment areas{1, {{0, 0, 1, 1}}, {0.5}};
    const FramePart part = partOf(config, &areas);
    EXPECT_EQ(part.pass.zoom, (Zoom{0.5, 0.5}));
    EXPECT_EQ(part.picture, (PixelViewport{0, 0, kWidth, kHeight}));
    EXPECT_LT(part.drawnWhole.w, kWidth);
    EXPECT_EQ(part.surface, part.picture);
}

TEST(FramePart, widensTheScissorOfMultisampledPicturesOnly) {
    PlayerConfig config;
    config.grid = {2, 1, 1};
    EXPECT_EQ(partOf(config).scissor, partOf(config).drawn);
    const FramePart part = partOf(config, nullptr, 1, 4);
    EXPECT_TRUE(part.scissor.contains(part.drawn));
    EXPECT_NE(part.scissor, part.drawn);
}

} // namespace
} // namespace mural::native
