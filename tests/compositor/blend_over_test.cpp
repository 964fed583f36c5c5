// Blending of rows: vector and scalar code agree, and each format rounds exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "compositor/kernels/blend_over.hpp"
#include "compositor/kernels/half_float.hpp"
#include "tests/compositor/random_bytes.hpp"

namespace mural::compositor::test {
namespace {

constexpr PlaneFormat kColours[] = {PlaneFormat::Rgba8, PlaneFormat::Rgb10A2, PlaneFormat::Rgba16F,
                                    PlaneFormat::Rgba32F};

std::vector<std::byte> randomPixels(std::mt19937& random, PlaneFormat format, size_t count) {
    std::vector<std::byte> bytes = randomBytes(random, count * bytesPerPixel(format));
    if (random() % 2) std::fill_n(bytes.begin(), bytes.size() / 2, std::byte{0}); // typical for most of a picture
    if (format == PlaneFormat::Rgba32F)
        for (size_t i = 0; i + 4 <= bytes.size(); i += 4) {
            static constexpr float kHard[] = {0.0f, -0.0f, 1.0f, 0.5f, 1e-40f, 3e38f, 0.1f, -2.0f};
            const float value = random() % 2 ? kHard[random() % 8] : static_cast<float>(random() % 1000) / 999.0f;
            std::memcpy(bytes.data() + i, &value, 4);
        }
    return bytes;
}

TEST(BlendOver, givesEqualResultsForVectorsAndPixels) {
    forEachTarget([](const char* target) {
        std::mt19937 random(2);
        for (const PlaneFormat format : kColours)
            for (const size_t count : {0, 1, 3, 4, 5, 8, 15, 16, 17, 31, 64, 65, 129, 1000})
                for (const SourceSide side : {SourceSide::Behind, SourceSide::InFront}) {
                    const std::vector<std::byte> source = randomPixels(random, format, count);
                    std::vector<std::byte> into = randomPixels(random, format, count);
                    std::vector<std::byte> expected = into;
                    blendOverRow(format, into.data(), source.data(), count, side);
                    blendOverRowScalar(format, expected.data(), source.data(), count, side);
                    ASSERT_EQ(into, expected) << target << " " << nameOf(format) << " " << count << " pixels";
                }
    });
}

// Every pair of bytes, compared with real numbers.
TEST(BlendOver, roundsBytesExactly) {
    for (unsigned alpha = 0; alpha < 256; ++alpha) {
        std::vector<uint8_t> back, front;
        for (unsigned value = 0; value < 256; ++value) {
            back.insert(back.end(), {static_cast<uint8_t>(value), static_cast<uint8_t>(255 - value), 7,
                                     static_cast<uint8_t>(value)});
            front.insert(front.end(), {static_cast<uint8_t>(alpha / 2), 0, static_cast<uint8_t>(value),
                                       static_cast<uint8_t>(alpha)});
        }
        std::vector<uint8_t> into = back;
        blendOverRow(PlaneFormat::Rgba8, reinterpret_cast<std::byte*>(into.data()),
                     reinterpret_cast<const std::byte*>(front.data()), 256, SourceSide::InFront);
        for (size_t i = 0; i < into.size(); ++i) {
            const double exact = std::min(255.0, front[i] + std::floor(back[i] * (255.0 - alpha) / 255.0 + 0.5));
            ASSERT_EQ(into[i], exact) << "alpha " << alpha << " component " << i;
        }
    }
}

TEST(BlendOver, roundsTenBitsExactly) {
    for (uint32_t alpha = 0; alpha < 4; ++alpha)
        for (uint32_t value = 0; value < 1024; ++value) {
            const uint32_t front = alpha << 30 | 5u << 20 | 1023u << 10 | value;
            uint32_t into = 2u << 30 | value << 20 | 1u << 10 | value;
            const uint32_t back = into;
            blendOverRow(PlaneFormat::Rgb10A2, reinterpret_cast<std::byte*>(&into),
                         reinterpret_cast<const std::byte*>(&front), 1, SourceSide::InFront);
            for (int shift = 0; shift < 30; shift += 10) {
                const double exact = std::min(
                    1023.0, (front >> shift & 1023) + std::floor((back >> shift & 1023) * (3.0 - alpha) / 3.0 + 0.5));
                ASSERT_EQ(into >> shift & 1023, exact) << alpha << " " << value;
            }
        }
}

// Emission without coverage: colour may exceed alpha.
TEST(BlendOver, saturates) {
    const uint8_t glow[8] = {200, 0, 255, 0, 200, 0, 255, 0};
    uint8_t into[8] = {100, 3, 255, 9, 255, 255, 1, 255};
    blendOverRow(PlaneFormat::Rgba8, reinterpret_cast<std::byte*>(into), reinterpret_cast<const std::byte*>(glow), 2,
                 SourceSide::InFront);
    const uint8_t expected[8] = {255, 3, 255, 9, 255, 255, 255, 255};
    EXPECT_EQ(std::memcmp(into, expected, sizeof into), 0);
}

// Opaque pixels stay opaque below any number of empty layers.
TEST(BlendOver, keepsOpaquePixelsWhenRepeated) {
    std::vector<uint8_t> into(64, 255);
    const std::vector<uint8_t> nothing(64, 0);
    std::vector<uint8_t> faint(64, 0);
    for (int i = 0; i < 16; ++i) {
        blendOverRow(PlaneFormat::Rgba8, reinterpret_cast<std::byte*>(into.data()),
                     reinterpret_cast<const std::byte*>(nothing.data()), 16, SourceSide::InFront);
        blendOverRow(PlaneFormat::Rgba8, reinterpret_cast<std::byte*>(into.data()),
                     reinterpret_cast<const std::byte*>(faint.data()), 16, SourceSide::Behind);
    }
    EXPECT_EQ(into, std::vector<uint8_t>(64, 255));
}

// Random layers compared with double precision: at most 1.7 for 8 layers and 2.4 for 32 in earlier measurements.
TEST(BlendOver, staysAccurateForManyLayers) {
    std::mt19937 random(3);
    double worst = 0;
    std::vector<uint8_t> sum(4 * 512, 0);
    std::vector<double> truth(4 * 512, 0.0);
    for (int layer = 0; layer < 32; ++layer) {
        std::vector<uint8_t> front(sum.size());
        for (size_t i = 0; i < front.size(); i += 4) {
            const unsigned alpha = random() % 256;
            for (int c = 0; c < 3; ++c)
                front[i + static_cast<size_t>(c)] = static_cast<uint8_t>(random() % (alpha + 1));
            front[i + 3] = static_cast<uint8_t>(alpha);
        }
        blendOverRow(PlaneFormat::Rgba8, reinterpret_cast<std::byte*>(sum.data()),
                     reinterpret_cast<const std::byte*>(front.data()), 512, SourceSide::InFront);
        for (size_t i = 0; i < truth.size(); ++i) truth[i] = front[i] + truth[i] * (255 - front[i / 4 * 4 + 3]) / 255;
    }
    for (size_t i = 0; i < truth.size(); ++i) worst = std::max(worst, std::abs(truth[i] - sum[i]));
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 3.0);
}

TEST(HalfFloat, roundTripsEveryHalf) {
    for (uint32_t half = 0; half < 0x10000; ++half) {
        const auto h = static_cast<uint16_t>(half);
        const float value = floatOfHalf(h);
        if (std::isnan(value))
            EXPECT_EQ(halfOfFloat(value), 0x7e00);
        else
            ASSERT_EQ(halfOfFloat(value), h) << half;
    }
    EXPECT_EQ(halfOfFloat(65519.0f), 0x7bff);         // the largest
    EXPECT_EQ(halfOfFloat(65520.0f), 0x7c00);         // a tie, to infinity
    EXPECT_EQ(halfOfFloat(std::ldexp(1.0f, -25)), 0); // a tie, to even
    EXPECT_EQ(halfOfFloat(std::ldexp(3.0f, -25)), 2);
    EXPECT_EQ(floatOfHalf(1), std::ldexp(1.0f, -24));
}

} // namespace
} // namespace mural::compositor::test
