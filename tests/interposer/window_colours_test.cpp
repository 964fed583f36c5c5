// Comparison and conversion of window pixels of all formats.
#include "interposer/readback/window_colours.hpp"

#include <GL/glext.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

namespace mural {
namespace {

template <class T, size_t N>
ColourDifference compare(const std::array<T, N>& a, const std::array<T, N>& b, GLenum type, size_t pixels) {
    return compareColours(a.data(), b.data(), pixels, type);
}

TEST(WindowColours, comparesBytesWithAlpha) {
    const std::array<uint8_t, 8> a{1, 2, 3, 255, 9, 9, 9, 9};
    std::array<uint8_t, 8> b = a;
    EXPECT_EQ(compare(a, b, GL_UNSIGNED_BYTE, 2).differingPixels, 0U);
    b[3] = 250;
    b[1] = 4;
    const ColourDifference difference = compare(a, b, GL_UNSIGNED_BYTE, 2);
    EXPECT_EQ(difference.differingPixels, 1U);
    EXPECT_EQ(difference.largest, 5U);
    EXPECT_EQ(difference.squared, 29U);
}

// One unit of ten bits is less than 1/255, and must be detected.
TEST(WindowColours, comparesTenBits) {
    const std::array<uint32_t, 3> a{0x3ff00000, 5, 1U << 30};
    const std::array<uint32_t, 3> b{0x3fe00000, 5, 2U << 30};
    const ColourDifference difference = compare(a, b, GL_UNSIGNED_INT_2_10_10_10_REV, 3);
    EXPECT_EQ(difference.differingPixels, 2U);
    EXPECT_EQ(difference.largest, 85U);
    EXPECT_EQ(difference.squared, 1U + 85U * 85U);
}

TEST(WindowColours, comparesFloats) {
    const std::array<float, 8> a{0.5F, 0, 2, 1, NAN, 0, 0, 1};
    std::array<float, 8> b{0.5F, -0.0F, 3, 1, NAN, 0, 0, 1};
    ColourDifference difference = compare(a, b, GL_FLOAT, 2);
    EXPECT_EQ(difference.differingPixels, 1U);
    EXPECT_EQ(difference.largest, 255U);
    b = a;
    b[0] = std::nextafter(0.5F, 1.0F);
    b[4] = 1;
    difference = compare(a, b, GL_FLOAT, 2);
    EXPECT_EQ(difference.differingPixels, 2U);
    EXPECT_EQ(difference.largest, 65536U * 255U) << "no number is far from any";
}

TEST(WindowColours, reducesToBytes) {
    std::array<uint32_t, 1> tens{3U << 30 | 1023U << 20 | 513U << 10 | 1U};
    reduceToBytes(tens.data(), 1, GL_UNSIGNED_INT_2_10_10_10_REV);
    EXPECT_EQ(tens[0], 0xffff8000U);
    std::array<float, 8> floats{0, 0.5F, 1, 7, -1, 0.25F, NAN, 0};
    reduceToBytes(floats.data(), 2, GL_FLOAT);
    const std::array<uint8_t, 8> wanted{0, 128, 255, 255, 0, 64, 0, 0};
    EXPECT_EQ(std::memcmp(floats.data(), wanted.data(), 8), 0);
}

} // namespace
} // namespace mural
