#include <gtest/gtest.h>

#include <limits>

#include "nodes/replay/tiling.hpp"

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

TEST(Tiling, EdgesInNormalisedDeviceCoordinates) {
    const TileValues v = tileValues(place());
    const std::array<GLfloat, 8> wanted{-0.1f, 1.1f, -0.2f, 1.2f, 1, 10, 0.01f, 0.02f};
    for (size_t i = 0; i < 8; ++i) EXPECT_FLOAT_EQ(v.cull[i], wanted[i]) << i;
    EXPECT_EQ(v.offset, (std::array<GLfloat, 4>{}));
}

TEST(Tiling, ViewportsMoveTheEdges) {
    TilePlace p = place();
    p.viewport = {100, 0, 50, 100};
    const TileValues v = tileValues(p);
    EXPECT_FLOAT_EQ(v.cull[0], 2 * (90.f - 100) / 50 - 1);
    EXPECT_FLOAT_EQ(v.cull[1], 2 * (210.f - 100) / 50 - 1);
}

TEST(Tiling, NothingIsDroppedWhereThatIsNotKnownToBeRight) {
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

TEST(Tiling, OffsetsOfATranslatedFramebuffer) {
    TilePlace p = place();
    p.translated = true;
    p.tile = {100, 0, 100, 50};
    EXPECT_EQ(tileValues(p).offset, (std::array<GLfloat, 4>{100, 0, 50, 0}));
}

} // namespace
} // namespace mural
