// Averages of pictures: vector and scalar code agree, and results are rounded exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "compositor/assembly/average.hpp"
#include "compositor/kernels/average_sums.hpp"
#include "compositor/kernels/half_float.hpp"
#include "tests/compositor/random_bytes.hpp"

namespace mural::compositor::test {
namespace {

TEST(Average, givesEqualResultsForVectorsAndPixels) {
    forEachTarget([](const char* target) {
        std::mt19937 random(4);
        for (const size_t count : {0, 1, 7, 8, 31, 33, 64, 129}) {
            const std::vector<std::byte> bytes = randomBytes(random, count);
            const auto* components = reinterpret_cast<const uint8_t*>(bytes.data());
            for (const uint32_t n : {1u, 2u, 3u, 16u, 64u, 256u, 257u}) {
                std::vector<uint16_t> sums(count), same;
                for (auto& s : sums) s = static_cast<uint16_t>(random() % (255 * (n - 1) + 1));
                same = sums;
                addToSums(sums.data(), components, count);
                addToSumsScalar(same.data(), components, count);
                ASSERT_EQ(sums, same) << target;
                std::vector<uint8_t> average(count), expected(count);
                averageOfSums(average.data(), sums.data(), count, n);
                averageOfSumsScalar(expected.data(), sums.data(), count, n);
                ASSERT_EQ(average, expected) << target << " n " << n;
            }
        }
    });
}

// Division in floats, for sums next to every step of the result.
TEST(Average, dividesExactlyAtEveryStep) {
    forEachTarget([](const char* target) {
        for (const uint32_t n : {1u, 2u, 3u, 7u, 64u, 257u, 258u, 1000u, 4099u, 65521u, kMaxAveraged8}) {
            std::vector<uint32_t> sums;
            for (uint32_t value = 0; value < 255; ++value)
                for (uint32_t d = 0; d < 4; ++d)
                    sums.push_back(
                        std::min(255 * n, value * n + (n + 1) / 2 + d - std::min(2u, value * n + (n + 1) / 2)));
            std::vector<uint8_t> average(sums.size()), expected(sums.size());
            averageOfSums(average.data(), sums.data(), sums.size(), n);
            averageOfSumsScalar(expected.data(), sums.data(), sums.size(), n);
            ASSERT_EQ(average, expected) << target << " n " << n;
        }
    });
}

// At most half a unit off, for every n, without drift.
TEST(Average, doesNotDriftInEightBits) {
    std::mt19937 random(5);
    for (const int n : {1, 2, 3, 16, 64, 257, 258, 600}) {
        Average average(PlaneFormat::Rgba8, 13, 3);
        std::vector<double> truth(13 * 3 * 4);
        for (int i = 0; i < n; ++i) {
            Plane picture(PlaneFormat::Rgba8, 13, 3);
            fillRandomly(random, picture.bytes());
            ASSERT_TRUE(average.add(picture.view()));
            for (size_t c = 0; c < truth.size(); ++c) truth[c] += std::to_integer<int>(picture.bytes()[c]);
        }
        Plane result(PlaneFormat::Rgba8, 13, 3);
        ASSERT_TRUE(average.write(result.view()));
        for (size_t c = 0; c < truth.size(); ++c)
            ASSERT_EQ(std::to_integer<int>(result.bytes()[c]), std::floor(truth[c] / n + 0.5)) << n;
    }
}

TEST(Average, supportsOtherFormats) {
    for (const PlaneFormat format : {PlaneFormat::Rgb10A2, PlaneFormat::Rgba16F, PlaneFormat::Rgba32F}) {
        Average average(format, 3, 2);
        Plane a(format, 3, 2), b(format, 3, 2), result(format, 3, 2);
        const auto fill = [&](Plane& p, uint32_t ten, float value) {
            for (size_t at = 0; at < p.bytes().size();) {
                const uint16_t half = halfOfFloat(value);
                if (format == PlaneFormat::Rgb10A2)
                    std::memcpy(p.bytes().data() + at, &ten, 4), at += 4;
                else if (format == PlaneFormat::Rgba16F)
                    std::memcpy(p.bytes().data() + at, &half, 2), at += 2;
                else
                    std::memcpy(p.bytes().data() + at, &value, 4), at += 4;
            }
        };
        fill(a, 3u << 30 | 1023u << 20 | 0u << 10 | 10, 1.0f);
        fill(b, 0u << 30 | 1022u << 20 | 1u << 10 | 20, 0.5f);
        ASSERT_TRUE(average.add(a.view()));
        ASSERT_TRUE(average.add(b.view()));
        ASSERT_TRUE(average.write(result.view()));
        fill(a, 2u << 30 | 1023u << 20 | 1u << 10 | 15, 0.75f); // ties go up
        EXPECT_EQ(result, a) << nameOf(format);
    }
}

TEST(Average, rejectsPicturesThatDoNotFit) {
    Average average(PlaneFormat::Rgba8, 4, 4);
    Plane small(PlaneFormat::Rgba8, 3, 4), fits(PlaneFormat::Rgba8, 4, 4), depth(PlaneFormat::D24S8, 4, 4);
    EXPECT_FALSE(average.write(fits.view()));
    EXPECT_FALSE(average.add(small.view()));
    EXPECT_FALSE(average.add(depth.view()));
    EXPECT_TRUE(average.add(fits.view()));
    EXPECT_FALSE(average.write(small.view()));
    EXPECT_EQ(average.count(), 1u);
    average.clear();
    EXPECT_FALSE(average.write(fits.view()));
}

} // namespace
} // namespace mural::compositor::test
