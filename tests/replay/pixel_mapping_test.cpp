// Positions of samples and kernel pixels of a render pass.
#include "nodes/player/pixel_mapping.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace mural {
namespace {

RenderPass kernel(int x, int y, int width, int height) {
    RenderPass p;
    p.kernelX = x;
    p.kernelY = y;
    p.kernelWidth = width;
    p.kernelHeight = height;
    return p;
}

TEST(PixelMapping, isTheIdentityForPlainPasses) {
    for (const double x : {0.0, 3.5, 16384.0}) EXPECT_EQ(placeInPass({}, x, -x), (std::array<double, 2>{x, -x}));
    EXPECT_EQ(inKernel({}, {-3, 4, 7, 9}), (PixelViewport{-3, 4, 7, 9}));
    EXPECT_EQ(moveInViewport({}, {10, 20, 300, 200}), (std::array<float, 4>{}));
}

// The centre of pixel i of a pass equals the centre of its window pixel.
TEST(PixelMapping, alignsCentresOfKernelPixels) {
    for (int width = 1; width <= 5; ++width)
        for (int k = 0; k < width; ++k)
            for (int i = 0; i < 4; ++i) {
                const auto at = placeInPass(kernel(k, 0, width, 1), width * i + k + 0.5, 0);
                EXPECT_DOUBLE_EQ(at[0], i + 0.5) << k << " of " << width;
            }
}

TEST(PixelMapping, placesSamplesBesideTheCentre) {
    RenderPass p;
    p.samples = 4;
    for (p.sample = 0; p.sample < 4; ++p.sample) {
        const auto jitter = jitterOf(p.sample, 4);
        const auto at = placeInPass(p, 10.5 + jitter[0], 20.5 + jitter[1]);
        EXPECT_DOUBLE_EQ(at[0], 10.5);
        EXPECT_DOUBLE_EQ(at[1], 20.5);
    }
}

// Compared with counting: pixel x of the window belongs to column x mod width.
TEST(PixelMapping, convertsRectanglesToKernels) {
    for (int width = 1; width <= 4; ++width)
        for (int k = 0; k < width; ++k)
            for (int x = 0; x < 9; ++x)
                for (int w = 0; w < 9; ++w) {
                    int first = -1, count = 0;
                    for (int at = x; at < x + w; ++at) {
                        if (at % width != k) continue;
                        if (first < 0) first = at / width;
                        ++count;
                    }
                    const PixelViewport got = inKernel(kernel(k, 0, width, 1), {x, 0, w, 1});
                    EXPECT_EQ(got.w, count) << x << "+" << w << ", " << k << " of " << width;
                    if (count > 0) {
                        EXPECT_EQ(got.x, first);
                    }
                    EXPECT_EQ(inKernel(kernel(0, k, 1, width), {0, x, 1, w}).h, count);
                }
}

TEST(PixelMapping, coversAWindowOnceWithKernels) {
    const PixelViewport window{0, 0, 253, 191};
    int64_t pixels = 0;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x) pixels += inKernel(kernel(x, y, 3, 2), window).area();
    EXPECT_EQ(pixels, window.area());
}

TEST(PixelMapping, relatesShownAndRepresentativePixels) {
    const RenderPass p = kernel(1, 0, 3, 2);
    EXPECT_EQ(shownByKernel(p, {2, 1, 4, 3}), (PixelViewport{7, 2, 10, 5}));
    EXPECT_EQ(inKernel(p, shownByKernel(p, {2, 1, 4, 3})), (PixelViewport{2, 1, 4, 3}));
    EXPECT_EQ(standingFor(p, {5, 3, 2, 2}), (PixelViewport{1, 1, 2, 2}));
    EXPECT_EQ(standingFor(p, {3, 2, 3, 2}), (PixelViewport{1, 1, 1, 1}));
}

RenderPass zoomed(double x, double y, RenderPass p = {}) {
    p.zoom = {x, y};
    return p;
}

// Disjoint parts of a window stay disjoint in a zoomed pass, without gaps.
TEST(PixelMapping, joinsZoomedParts) {
    for (const double zoom : {0.5, 0.3, 0.77, 0.999, 1.5, 2.0, 3.7, 16.0})
        for (const int width : {320, 321, 1001}) {
            const RenderPass p = zoomed(zoom, 1);
            const PixelViewport all = inPass(p, {0, 0, width, 10});
            EXPECT_EQ(all.h, 10);
            EXPECT_NEAR(all.w, width * zoom, 1);
            int32_t at = 0;
            for (int32_t x = 0; x < width; x += 7) {
                const PixelViewport part = inPass(p, {x, 0, std::min(7, width - x), 10});
                EXPECT_EQ(part.x, at) << zoom << " " << width;
                at += part.w;
            }
            EXPECT_EQ(at, all.w);
        }
}

TEST(PixelMapping, alignsCentresOfZoomedPixels) {
    EXPECT_EQ(placeInPass(zoomed(0.5, 0.25), 8, 8), (std::array<double, 2>{4, 2}));
    const auto at = placeInPass(zoomed(0.5, 0.5, kernel(1, 0, 2, 1)), 2 * 10 + 1 + 0.5, 0); // pixel 10 of the kernel
    EXPECT_DOUBLE_EQ(at[0], 10.5 / 2);
    const auto stands = standingFor(zoomed(0.5, 0.5), 9, 10);
    EXPECT_EQ(stands.x, 4);
    EXPECT_EQ(stands.y, 5);
    const std::array<float, 4> v{30, 40, 640, 360};
    const auto move = moveInViewport(zoomed(0.5, 0.3), v);
    for (const double ndc : {-1.0, 0.0, 0.7}) {
        const double x = ndc + ndc * static_cast<double>(move[0]) + static_cast<double>(move[2]);
        EXPECT_NEAR(v[0] + (x + 1) * v[2] / 2, (v[0] + (ndc + 1) * v[2] / 2) * 0.5, 1e-3);
    }
}

TEST(PixelMapping, acceptsAnyRectangle) {
    constexpr int32_t kMax = std::numeric_limits<int32_t>::max(), kMin = std::numeric_limits<int32_t>::min();
    for (const PixelViewport& r : {PixelViewport{kMax, kMax, kMax, kMax}, PixelViewport{kMin, kMin, kMax, kMax},
                                   PixelViewport{kMin, 0, kMin, 1}})
        for (const int width : {1, 2, 16}) (void)inKernel(kernel(width - 1, 0, width, 1), r);
    EXPECT_EQ(moveInViewport(kernel(0, 0, 2, 1), {0, 0, 0, 10}), (std::array<float, 4>{}));
    EXPECT_EQ(moveInViewport(kernel(0, 0, 2, 1), {0, 0, std::numeric_limits<float>::quiet_NaN(), 10}),
              (std::array<float, 4>{}));
}

// A position moved within its viewport equals the position in a moved viewport.
TEST(PixelMapping, movesPositionsLikeViewports) {
    RenderPass p = kernel(2, 1, 3, 2);
    p.samples = 5;
    p.sample = 3;
    const std::array<float, 4> v{30, 40, 640, 360};
    const auto move = moveInViewport(p, v);
    for (const double ndc : {-1.0, -0.3, 0.0, 0.7, 1.0}) {
        const auto wanted = placeInPass(p, v[0] + (ndc + 1) * v[2] / 2, v[1] + (ndc + 1) * v[3] / 2);
        const double x = ndc + ndc * static_cast<double>(move[0]) + static_cast<double>(move[2]),
                     y = ndc + ndc * static_cast<double>(move[1]) + static_cast<double>(move[3]);
        EXPECT_NEAR(v[0] + (x + 1) * v[2] / 2, wanted[0], 1e-3);
        EXPECT_NEAR(v[1] + (y + 1) * v[3] / 2, wanted[1], 1e-3);
    }
}

} // namespace
} // namespace mural
