// Geometry of a tile: culling edges, offsets and positions.
#include <gtest/gtest.h>

#include <limits>

#include "nodes/replay/programs/tiling.hpp"

namespace mural {
namespace {

TilePlace place() {
    TilePlace p;
    p.window = {0, 0, 200, 100};
    p.tile = {100, 50, 100, 50};
    p.viewport = {0, 0, 200, 100};
    p.marginPixels = 10;
    return p;
}

TEST(Tiling, computesEdgesInNormalisedDeviceCoordinates) {
    const TileValues v = tileValues(place());
    const std::array<GLfloat, 8> wanted{-0.1f, 1.1f, -0.2f, 1.2f, 1, 10, 0.01f, 0.02f};
    for (size_t i = 0; i < 8; ++i) EXPECT_FLOAT_EQ(v.cull[i], wanted[i]) << i;
    EXPECT_EQ(v.place, (std::array<GLfloat, 8>{}));
}

TEST(Tiling, movesEdgesWithViewports) {
    TilePlace p = place();
    p.viewport = {100, 0, 50, 100};
    const TileValues v = tileValues(p);
    EXPECT_FLOAT_EQ(v.cull[0], 2 * (90.f - 100) / 50 - 1);
    EXPECT_FLOAT_EQ(v.cull[1], 2 * (210.f - 100) / 50 - 1);
}

TEST(Tiling, dropsNothingWhenUnsafe) {
    const auto off = [](auto change) {
        TilePlace p = place();
        change(p);
        return tileValues(p).cull[4] == 0;
    };
    EXPECT_FALSE(off([](TilePlace&) {}));
    EXPECT_TRUE(off([](TilePlace& p) { p.mayCull = false; }));
    EXPECT_TRUE(off([](TilePlace& p) { p.tile = p.window; }));
    EXPECT_TRUE(off([](TilePlace& p) { p.viewport = {0, 0, 0, 100}; }));
    EXPECT_TRUE(off([](TilePlace& p) { p.viewport = {0, 0, 20000, 100}; }));
    EXPECT_TRUE(off([](TilePlace& p) { p.viewport = {0, std::numeric_limits<float>::quiet_NaN(), 100, 100}; }));
}

TEST(Tiling, computesOffsetsOfATranslatedFramebuffer) {
    TilePlace p = place();
    p.translated = true;
    p.tile = {100, 0, 100, 50};
    EXPECT_EQ(tileValues(p).place, (std::array<GLfloat, 8>{100, 0, 50, 0, 0, 0, 0, 0}));
}

// Pixel i of column 1 of 3 is the window's pixel 3 i + 1, and its centre lies half a pixel further. Rows with an upper
// origin count from the top of the window.
TEST(Tiling, computesPositionsOfAKernel) {
    TilePlace p = place();
    p.window = {0, 0, 200, 100};
    p.pass.kernelX = 1, p.pass.kernelWidth = 3, p.pass.kernelY = 1, p.pass.kernelHeight = 2;
    const auto v = tileValues(p).place;
    const auto x = [&](double i) { return i + 0.5 + (i + 0.5) * v[4] + v[0]; };
    EXPECT_EQ(x(0), 1.5);
    EXPECT_EQ(x(20), 61.5);
    const auto y = [&](double j) { return j + 0.5 + (j + 0.5) * v[5] + v[1]; };
    EXPECT_EQ(y(0), 1.5);
    EXPECT_EQ(y(7), 15.5);
    const auto fromAbove = [&](double j) { return 100 - (j + 0.5) + (100 - (j + 0.5)) * v[5] + v[2]; };
    EXPECT_EQ(fromAbove(7), 100 - 15.5);
}

TEST(Tiling, computesPositionsOfASmallerPicture) {
    TilePlace p = place();
    p.pass.zoom = {0.5, 0.25};
    const auto v = tileValues(p).place;
    EXPECT_EQ(10.5 + 10.5 * v[4] + v[0], 21);
    EXPECT_EQ(10.5 + 10.5 * v[5] + v[1], 42);
}

} // namespace
} // namespace mural
