// Samples and kernels of unmodified programs: positions compared with wider arithmetic.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <set>

#include "common/geometry/jitter.hpp"
#include "nodes/player/pixel_mapping.hpp"
#include "tests/numerics/case_table.hpp"

namespace mural {
namespace {

using Exact = long double;

// In integers: (2 i + 1 - n) / 2n once on each axis; so the sum is 0, and no picture shifts.
TEST(Passes, placeOneSampleInEveryColumnAndRow) {
    for (int n = 1; n <= 257; ++n) {
        std::set<long> columns, rows;
        long sumX = 0, sumY = 0;
        for (int i = 0; i < n; ++i) {
            const Jitter j = jitterOf({i, n});
            const long x = std::lround(j.x * 2 * n), y = std::lround(j.y * 2 * n);
            ASSERT_NEAR(j.x * 2 * n, static_cast<double>(x), 1e-9) << n;
            ASSERT_NEAR(j.y * 2 * n, static_cast<double>(y), 1e-9) << n;
            ASSERT_TRUE(columns.insert(x).second && rows.insert(y).second)
                << "sample " << i << " of " << n << " stands where another does";
            ASSERT_TRUE(std::abs(x) < n && std::abs(y) < n && (x + n) % 2 != 0 && (y + n) % 2 != 0) << n;
            sumX += x;
            sumY += y;
        }
        ASSERT_EQ(sumX, 0) << n;
        ASSERT_EQ(sumY, 0) << n;
    }
}

// The last lines of the vertex shader in floats, then an exact viewport transform.
Exact shown(float ndc, float scaleLess1, float offset, float origin, float size) {
    const float moved = ndc + (ndc * scaleLess1 + offset);
    return static_cast<Exact>(origin) + (static_cast<Exact>(moved) + 1) * static_cast<Exact>(size) / 2;
}

// In pixels of the pass: the error of the moved position. Half the picture times the last bit at the magnitude of the
// offset, which a float position also loses natively.
TEST(Passes, moveVerticesAccurately) {
    std::mt19937 random(5);
    for (const int size : {191, 253, 1000, 1921, 4096, 16384}) {
        double worst = 0;
        for (int trial = 0; trial < 20000; ++trial) {
            RenderPass p;
            p.kernelWidth = 1 + static_cast<int>(random() % 8);
            p.kernelX = static_cast<int>(random() % static_cast<unsigned>(p.kernelWidth));
            p.samples = 1 + static_cast<int>(random() % 64);
            p.sample = static_cast<int>(random() % static_cast<unsigned>(p.samples));
            const auto origin = static_cast<float>(random() % 3 ? 0 : static_cast<int>(random() % 100) - 50);
            const std::array<float, 4> viewport{origin, 0, static_cast<float>(size), static_cast<float>(size)};
            const auto move = moveInViewport(p, viewport);
            const auto ndc = static_cast<float>(std::uniform_real_distribution<>(-1, 1)(random));
            const Exact at = static_cast<Exact>(origin) + (static_cast<Exact>(ndc) + 1) * size / 2;
            const Jitter jitter = jitterOf({p.sample, p.samples});
            const Exact wanted = (at - p.kernelX - 0.5L - static_cast<Exact>(jitter.x)) / p.kernelWidth + 0.5L;
            worst = std::max(worst,
                             static_cast<double>(std::abs(shown(ndc, move[0], move[2], origin, viewport[2]) - wanted)));
        }
        numerics::expectWithin("positions moved for samples and kernels in floats, " + std::to_string(size) +
                                   " pixels wide",
                               "64 bits of mantissa", worst, size * 0x1p-23, "pixels");
    }
}

// A sample's position maps to the centre of its pixel: exactly in doubles, for every count and far from the origin.
TEST(Passes, areExactFarFromTheOrigin) {
    for (const int size : {1, 253, 16384, 32768})
        for (int n = 1; n <= 64; ++n)
            for (int i = 0; i < n; ++i) {
                RenderPass p;
                p.samples = n;
                p.sample = i;
                const Jitter jitter = jitterOf({i, n});
                const auto at = placeInPass(p, size - 0.5 + jitter.x, size - 0.5 + jitter.y);
                ASSERT_NEAR(at[0], size - 0.5, 1e-11);
                ASSERT_NEAR(at[1], size - 0.5, 1e-11);
            }
}

} // namespace
} // namespace mural
