// Regions that are extended to whole bins of the software rasteriser.
#include "nodes/player/raster_bins.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

constexpr PixelViewport kSurface{0, 0, 1000, 777};

TEST(RasterBins, countsFromTheUpperLeftCorner) {
    // Rows 388 to 777 are 0 to 389 from above: bins 0 to 6.
    EXPECT_EQ(widenToBins({333, 388, 333, 389}, kSurface), (PixelViewport{320, 329, 384, 448}));
    EXPECT_EQ(widenToBins({0, 0, 333, 388}, kSurface), (PixelViewport{0, 0, 384, 393}));
}

TEST(RasterBins, keepsRegionsOfWholeBins) {
    for (const PixelViewport& region :
         {kSurface, PixelViewport{64, 777 - 128, 128, 64}, PixelViewport{960, 0, 40, 777 - 768}})
        EXPECT_EQ(widenToBins(region, kSurface), region);
}

TEST(RasterBins, staysInsideTheSurface) {
    EXPECT_EQ(widenToBins({990, 770, 10, 7}, kSurface), (PixelViewport{960, 713, 40, 64}));
    EXPECT_EQ(widenToBins({10, 10, 5, 5}, {0, 0, 37, 23}), (PixelViewport{0, 0, 37, 23}));
    EXPECT_EQ(widenToBins({900, 700, 5000, 5000}, kSurface), (PixelViewport{896, 649, 104, 128}));
}

TEST(RasterBins, keepsEmptyRegionsEmpty) {
    EXPECT_TRUE(widenToBins({}, kSurface).empty());
    EXPECT_TRUE(widenToBins({70, 70, 0, 5}, kSurface).empty());
}

// Every pixel of each bin that the region touches is inside, and no pixel of another bin.
TEST(RasterBins, coversEachTouchedBinCompletely) {
    const PixelViewport surface{0, 0, 150, 131};
    for (int32_t x = 0; x < 150; x += 13)
        for (int32_t y = 0; y < 131; y += 11) {
            const PixelViewport region = intersect({x, y, 40, 30}, surface), widened = widenToBins(region, surface);
            EXPECT_TRUE(widened.contains(region));
            for (int32_t column = 0; column < 3; ++column)
                for (int32_t row = 0; row < 3; ++row) {
                    const PixelViewport bin = intersect({64 * column, 131 - 64 * (row + 1), 64, 64}, surface);
                    const bool touched = !intersect(bin, region).empty();
                    EXPECT_EQ(intersect(bin, widened), touched ? bin : PixelViewport{})
                        << x << ", " << y << " bin " << column << ", " << row;
                }
        }
}

} // namespace
} // namespace mural
