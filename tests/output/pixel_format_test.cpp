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
    converter->convertRow(pixel, 1, reinterpret_cast<std::byte*>(&stored));
    return stored;
}

} // namespace

TEST(PixelFormat, sixteenBitsRoundAsOpenGlDoes) {
    const PixelFormat format{16, 16, 32, 0xf800, 0x07e0, 0x001f};
    for (int value = 0; value < 256; ++value) {
        const auto five = static_cast<uint32_t>(std::lround(value / 255.0 * 31));
        const auto six = static_cast<uint32_t>(std::lround(value / 255.0 * 63));
        EXPECT_EQ(convertOne(format, value, 0, 0), five << 11);
        EXPECT_EQ(convertOne(format, 0, value, 0), six << 5);
        EXPECT_EQ(convertOne(format, 0, 0, value), five);
    }
}

TEST(PixelFormat, thirtyBits) {
    const PixelFormat format{30, 32, 32, 0x3ff00000, 0x000ffc00, 0x000003ff};
    EXPECT_EQ(convertOne(format, 255, 255, 255), 0x3fffffffU);
    for (int value = 0; value < 256; ++value)
        EXPECT_EQ(convertOne(format, 0, 0, value),
                  static_cast<uint32_t>(std::lround(value / 255.0 * 1023)));
}

TEST(PixelFormat, depth32IsOpaque) {
    EXPECT_EQ(convertOne({32, 32, 32, 0xff0000, 0xff00, 0xff}, 1, 2, 3), 0xff010203U);
}

TEST(PixelFormat, swappedChannels) {
    EXPECT_EQ(convertOne({24, 32, 32, 0xff, 0xff00, 0xff0000}, 1, 2, 3), 0x030201U);
}

TEST(PixelFormat, threeBytesPerPixelArePadded) {
    auto converter = PixelConverter::make({24, 24, 32, 0xff0000, 0xff00, 0xff});
    ASSERT_TRUE(converter);
    EXPECT_EQ(converter->rowBytes(3), 12U);
    EXPECT_EQ(converter->rowBytes(4), 12U);
    const std::byte two[8] = {std::byte{1}, std::byte{2}, std::byte{3}, std::byte{0},
                              std::byte{4}, std::byte{5}, std::byte{6}, std::byte{0}};
    unsigned char stored[7] = {0, 0, 0, 0, 0, 0, 99};
    converter->convertRow(two, 2, reinterpret_cast<std::byte*>(stored));
    const unsigned char expected[7] = {1, 2, 3, 4, 5, 6, 99};
    EXPECT_EQ(std::memcmp(stored, expected, sizeof stored), 0);
}

TEST(PixelFormat, refusesWhatHasNoColours) {
    EXPECT_FALSE(PixelConverter::make({8, 8, 32, 0, 0, 0}));
    EXPECT_FALSE(PixelConverter::make({24, 32, 32, 0xf0f000, 0xff00, 0xff}));
    EXPECT_FALSE(PixelConverter::make({4, 4, 32, 8, 6, 1}));
}

} // namespace mural::test
