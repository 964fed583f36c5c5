// Operators on viewports, ranges, kernels and zooms.
#include <gtest/gtest.h>

#include "common/geometry/pixel_kernel.hpp"
#include "common/geometry/range.hpp"
#include "common/geometry/sub_pixel.hpp"
#include "common/geometry/viewport.hpp"
#include "common/geometry/zoom.hpp"

namespace mural {

TEST(Geometry, dividesAScreenIntoThirds) {
    const PixelViewport screen{0, 0, 1920, 1080};
    const PixelViewport middle = apply(screen, Viewport{.333333, 0, .333333, 1});
    EXPECT_EQ(middle, (PixelViewport{639, 0, 640, 1080}));
    EXPECT_EQ(relativeTo(middle, screen).x, 639. / 1920);
    EXPECT_EQ(relativeTo(screen, screen), Viewport{});
}

// Edges with equal decimal values are one pixel edge, even if their binary values differ.
TEST(Geometry, givesNeighboursCommonEdges) {
    for (int size = 1; size < 3000; size += 7) {
        for (int cut = 1; cut < 1000; ++cut) {
            for (const int width : {1, 7, 333}) {
                if (cut + width > 1000) continue;
                const PixelViewport all{5, 0, size, 1};
                const PixelViewport left = apply(all, Viewport{cut / 1000., 0, width / 1000., 1});
                ASSERT_EQ(left.right(), apply(all, Viewport{(cut + width) / 1000., 0, .1, 1}).x)
                    << size << " " << cut << " " << width;
            }
        }
    }
}

TEST(Geometry, composesViewports) {
    EXPECT_EQ(compose(Viewport{.5, 0, .5, 1}, {.5, .5, .5, .5}), (Viewport{.75, .5, .25, .5}));
    EXPECT_EQ(relativeTo(Viewport{.75, .5, .25, .5}, {.5, 0, .5, 1}), (Viewport{.5, .5, .5, .5}));
    // A segment and a view with a common right half.
    EXPECT_EQ(relativeTo(intersect(Viewport{0, 0, .5, 1}, {.25, 0, .5, 1}), {0, 0, .5, 1}), (Viewport{.5, 0, .5, 1}));
    EXPECT_EQ(relativeTo(intersect(Viewport{0, 0, .5, 1}, {.25, 0, .5, 1}), {.25, 0, .5, 1}), (Viewport{0, 0, .5, 1}));
    EXPECT_TRUE(intersect(Viewport{.1, 0, .7, 1}, {.8, 0, .2, 1}).empty());
    EXPECT_EQ(intersect(Viewport{.1, 0, .7, 1}, {}), (Viewport{.1, 0, .7, 1}));
}

TEST(Geometry, composesRangesKernelsAndSamples) {
    EXPECT_EQ(compose(Range{0, .5}, {.5, 1}), (Range{.25, .5}));
    EXPECT_EQ(compose(SubPixel{0, 2}, {1, 2}), (SubPixel{1, 4}));
    EXPECT_EQ(compose(SubPixel{1, 2}, {1, 2}), (SubPixel{3, 4}));
    EXPECT_EQ(compose(PixelKernel{1, 0, 2, 1}, {1, 0, 2, 1}), (PixelKernel{3, 0, 4, 1}));
    // Pixel i of the second of two kernels within the first of two is pixel 2 · (1 + 2 i) of all. Equalizer uses 1 + 4
    // i, which does not belong to the first kernel.
    EXPECT_EQ(compose(PixelKernel{0, 0, 2, 1}, {1, 0, 2, 1}), (PixelKernel{2, 0, 4, 1}));
    EXPECT_EQ(apply(PixelViewport{3, 4, 11, 7}, PixelKernel{1, 0, 4, 2}), (PixelViewport{3, 4, 3, 4}));
    EXPECT_EQ(apply(PixelViewport{100, 50, 801, 601}, Zoom{.5, .5}), (PixelViewport{50, 25, 401, 301}));
}

TEST(Geometry, staysFiniteForHugeNumbers) {
    const PixelViewport far = apply(PixelViewport{0, 0, 1 << 30, 1 << 30}, Viewport{1e300, -1e300, 1e300, 1e300});
    EXPECT_GE(far.x, 0);
    EXPECT_LE(far.y, 0);
    (void)apply(PixelViewport{1, 1, 1 << 30, 1}, Zoom{1e200, 1e-200});
}

} // namespace mural
