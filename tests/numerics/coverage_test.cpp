// Tiles, viewports and kernels: every pixel belongs to exactly one part.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "common/geometry/pixel_kernel.hpp"
#include "common/geometry/tile_grid.hpp"
#include "common/geometry/viewport.hpp"

namespace mural {
namespace {

// Difficult sizes: primes, neighbours of powers of two, the largest GL viewports, and beyond.
constexpr int32_t kSizes[] = {1,    2,    3,    7,    63,   64,   65,    127,   191,   253,   777,  1000,
                              1023, 1080, 1921, 2047, 4099, 8191, 16381, 16384, 32749, 32767, 32768};

TEST(Coverage, joinsTilesAtEveryEdge) {
    for (const int32_t size : kSizes)
        for (int n = 1; n <= 257; ++n)
            for (const int alignment : {1, 2, 64}) {
                int32_t reached = 0, widest = 0;
                for (int i = 0; i < n; ++i) {
                    const PixelViewport tile = tileViewport({n, 1, alignment}, i, 0, size, 1);
                    ASSERT_EQ(tile.x, reached) << size << " pixels, tile " << i << " of " << n << " by " << alignment;
                    ASSERT_GE(tile.w, 0) << size << " pixels, tile " << i << " of " << n << " by " << alignment;
                    ASSERT_TRUE(tile.x % alignment == 0 || tile.x == size) << tile.x << " by " << alignment;
                    reached += tile.w;
                    widest = std::max(widest, tile.w);
                }
                ASSERT_EQ(reached, size) << n << " tiles by " << alignment;
                ASSERT_LE(widest, (size + n - 1) / n + 2 * (alignment - 1))
                    << size << " pixels, " << n << " tiles by " << alignment;
            }
}

// Counts in two dimensions: rows and columns are independent.
TEST(Coverage, assignsEveryPixelToOneTile) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 300; ++trial) {
        const auto width = static_cast<int32_t>(1 + random() % 200), height = static_cast<int32_t>(1 + random() % 150);
        const TileGrid grid{static_cast<int>(1 + random() % 20), static_cast<int>(1 + random() % 20),
                            random() % 2 ? 2 : 1};
        std::vector<int> seen(static_cast<size_t>(width) * static_cast<size_t>(height), 0);
        for (int row = 0; row < grid.rows; ++row)
            for (int column = 0; column < grid.columns; ++column) {
                const PixelViewport tile = tileViewport(grid, column, row, width, height);
                for (int32_t y = tile.y; y < tile.top(); ++y)
                    for (int32_t x = tile.x; x < tile.right(); ++x) ++seen.at(static_cast<size_t>(y * width + x));
            }
        for (const int n : seen)
            ASSERT_EQ(n, 1) << width << "x" << height << " in " << grid.columns << "x" << grid.rows << ", trial "
                            << trial;
    }
}

// A viewport of i n-ths starts at the pixel that integer arithmetic gives: floor(size i / n).
TEST(Coverage, matchesIntegerArithmeticForFractions) {
    for (const int32_t size : kSizes)
        for (int32_t n = 1; n <= 640; ++n)
            for (int32_t i = 0; i < n; ++i) {
                const PixelViewport got = apply(PixelViewport{0, 0, size, size}, Viewport{double(i) / n, 0, 1. / n, 1});
                ASSERT_EQ(got.x, int64_t{size} * i / n) << i << "/" << n << " of " << size;
                ASSERT_EQ(got.right(), int64_t{size} * (i + 1) / n) << i << "/" << n << " of " << size;
            }
}

// Nested viewports: each cut applies to both sides, with sizes by subtraction as equalizers compute them.
void cut(std::mt19937& random, const Viewport& part, int depth, int32_t width, int32_t height, int64_t& pixels,
         std::vector<PixelViewport>& leaves) {
    if (depth == 0) {
        leaves.push_back(apply(PixelViewport{0, 0, width, height}, part));
        pixels += leaves.back().area();
        return;
    }
    const double share = static_cast<double>(1 + random() % 9) / 10;
    Viewport first{0, 0, 1, 1}, second{0, 0, 1, 1};
    (random() % 2 ? first.w : first.h) = share;
    if (first.w < 1)
        second.x = share, second.w = 1 - share;
    else
        second.y = share, second.h = 1 - share;
    cut(random, compose(part, first), depth - 1, width, height, pixels, leaves);
    cut(random, compose(part, second), depth - 1, width, height, pixels, leaves);
}

TEST(Coverage, coversOnceWithNestedViewports) {
    for (unsigned seed = 1; seed <= 400; ++seed) {
        std::mt19937 random(seed);
        const int32_t width = kSizes[random() % std::size(kSizes)], height = kSizes[random() % std::size(kSizes)];
        int64_t pixels = 0;
        std::vector<PixelViewport> leaves;
        cut(random, {}, 6, width, height, pixels, leaves);
        ASSERT_EQ(pixels, int64_t{width} * height) << "seed " << seed; // with no overlap below: each pixel once
        for (size_t a = 0; a < leaves.size(); ++a)
            for (size_t b = 0; b < a; ++b) ASSERT_TRUE(intersect(leaves[a], leaves[b]).empty()) << "seed " << seed;
    }
}

// Nested kernels: every pixel of a row belongs to one of them, even if widths do not divide.
TEST(Coverage, coversOnceWithNestedKernels) {
    for (const int32_t size : kSizes)
        for (const int32_t outer : {1, 2, 3, 5, 8})
            for (const int32_t inner : {1, 2, 3, 7}) {
                std::vector<int> seen(static_cast<size_t>(size), 0);
                for (int32_t a = 0; a < outer; ++a)
                    for (int32_t b = 0; b < inner; ++b) {
                        const PixelKernel k = compose(PixelKernel{a, 0, outer, 1}, PixelKernel{b, 0, inner, 1});
                        ASSERT_TRUE(k.valid());
                        const int32_t columns = apply(PixelViewport{0, 0, size, 1}, k).w;
                        for (int32_t i = 0; i < columns; ++i) {
                            ASSERT_EQ(k.x + k.w * i, a + outer * (b + inner * i)) << "not a pixel of the outer kernel";
                            if (k.x + k.w * i < size) ++seen[static_cast<size_t>(k.x + k.w * i)];
                        }
                    }
                for (const int n : seen) ASSERT_EQ(n, 1) << size << ": " << inner << " in " << outer;
            }
}

} // namespace
} // namespace mural
