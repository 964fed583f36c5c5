// Conversion of pictures to the pixel formats of X visuals.
#include "nodes/output/pixel_format.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

namespace mural::test {

namespace {

uint32_t convertOne(const PixelFormat& format, int red, int green, int blue) {
    auto converter = PixelConverter::make(format);
    EXPECT_TRUE(converter);
    const std::byte pixel[4] = {static_cast<std::byte>(blue), static_cast<std::byte>(green),
                                static_cast<std::byte>(red), std::byte{0x5a}};
    uint32_t stored = 0;
    converter->convertRow(PictureFormat::Bgra8, pixel, 1, reinterpret_cast<std::byte*>(&stored));
    return stored;
}

uint32_t convertDeep(const PixelFormat& format, uint32_t word) {
    auto converter = PixelConverter::make(format);
    EXPECT_TRUE(converter);
    uint32_t stored = 0;
    converter->convertRow(PictureFormat::Bgr10A2, reinterpret_cast<const std::byte*>(&word), 1,
                          reinterpret_cast<std::byte*>(&stored));
    return stored;
}

} // namespace

TEST(PixelFormat, roundsSixteenBitsAsOpenGlDoes) {
    const PixelFormat format{16, 16, 32, 0xf800, 0x07e0, 0x001f};
    for (int value = 0; value < 256; ++value) {
        const auto five = static_cast<uint32_t>(std::lround(value / 255.0 * 31));
        const auto six = static_cast<uint32_t>(std::lround(value / 255.0 * 63));
        EXPECT_EQ(convertOne(format, value, 0, 0), five << 11);
        EXPECT_EQ(convertOne(format, 0, value, 0), six << 5);
        EXPECT_EQ(convertOne(format, 0, 0, value), five);
    }
}

TEST(PixelFormat, convertsToThirtyBits) {
    const PixelFormat format{30, 32, 32, 0x3ff00000, 0x000ffc00, 0x000003ff};
    EXPECT_EQ(convertOne(format, 255, 255, 255), 0x3fffffffU);
    for (int value = 0; value < 256; ++value)
        EXPECT_EQ(convertOne(format, 0, 0, value), static_cast<uint32_t>(std::lround(value / 255.0 * 1023)));
}

// As drivers write them: the upper bits lie beyond the depth.
TEST(PixelFormat, copiesDeepPixelsOfTheSameLayout) {
    EXPECT_EQ(convertDeep({30, 32, 32, 0x3ff00000, 0x000ffc00, 0x000003ff}, 0x9f1ada92U), 0x9f1ada92U);
}

TEST(PixelFormat, convertsDeepPixels) {
    const uint32_t word = 1U << 30 | 0x3ffU << 20 | 0x155U << 10 | 3U; // red, green, blue
    EXPECT_EQ(convertDeep({30, 32, 32, 0x3ff, 0xffc00, 0x3ff00000}, word), 3U << 20 | 0x155U << 10 | 0x3ffU);
    EXPECT_EQ(convertDeep({32, 32, 32, 0xff0000, 0xff00, 0xff}, word), 0x55U << 24 | 0xffU << 16 | 85U << 8 | 1U);
    EXPECT_EQ(convertDeep({16, 16, 32, 0xf800, 0x07e0, 0x001f}, word), 0x1fU << 11 | 21U << 5);
}

TEST(PixelFormat, keepsAlphaAtDepth32) {
    EXPECT_EQ(convertOne({32, 32, 32, 0xff0000, 0xff00, 0xff}, 1, 2, 3), 0x5a010203U);
    EXPECT_EQ(convertOne({32, 32, 32, 0xff, 0xff00, 0xff0000}, 1, 2, 3), 0x5a030201U);
}

TEST(PixelFormat, swapsChannels) { EXPECT_EQ(convertOne({24, 32, 32, 0xff, 0xff00, 0xff0000}, 1, 2, 3), 0x030201U); }

TEST(PixelFormat, padsThreeBytesPerPixel) {
    auto converter = PixelConverter::make({24, 24, 32, 0xff0000, 0xff00, 0xff});
    ASSERT_TRUE(converter);
    EXPECT_EQ(converter->rowBytes(3), 12U);
    EXPECT_EQ(converter->rowBytes(4), 12U);
    const std::byte two[8] = {std::byte{1}, std::byte{2}, std::byte{3}, std::byte{0},
                              std::byte{4}, std::byte{5}, std::byte{6}, std::byte{0}};
    unsigned char stored[7] = {0, 0, 0, 0, 0, 0, 99};
    converter->convertRow(PictureFormat::Bgra8, two, 2, reinterpret_cast<std::byte*>(stored));
    const unsigned char expected[7] = {1, 2, 3, 4, 5, 6, 99};
    EXPECT_EQ(std::memcmp(stored, expected, sizeof stored), 0);
}

TEST(PixelFormat, rejectsFormatsWithoutColours) {
    EXPECT_FALSE(PixelConverter::make({8, 8, 32, 0, 0, 0}));
    EXPECT_FALSE(PixelConverter::make({24, 32, 32, 0xf0f000, 0xff00, 0xff}));
    EXPECT_FALSE(PixelConverter::make({4, 4, 32, 8, 6, 1}));
}

} // namespace mural::test
