// Reduction of pictures before their transfer.
#include "nodes/frame_transfer/transfer_scale.hpp"

#include <gtest/gtest.h>
#include <random>

namespace mural {
namespace {

std::vector<std::byte> noise(int32_t w, int32_t h) {
    std::mt19937 random(7);
    std::vector<std::byte> pixels(ScaledSize{w, h}.bytes());
    for (std::byte& b : pixels) b = static_cast<std::byte>(random() & 255);
    return pixels;
}

int at(const std::vector<std::byte>& pixels, int32_t w, int32_t x, int32_t y, int c) {
    return std::to_integer<int>(pixels[static_cast<size_t>((y * w + x) * 4 + c)]);
}

TEST(TransferScale, computesWholeSizesThatAreNeverLarger) {
    EXPECT_EQ(scaledSizeOf(101, 50, {.5, .5}).w, 51);
    EXPECT_EQ(scaledSizeOf(101, 50, {.5, .5}).h, 25);
    EXPECT_EQ(scaledSizeOf(3, 1, {.01, .01}).w, 1);
    EXPECT_EQ(scaledSizeOf(10, 10, {4, 1}).w, 10);
    EXPECT_EQ(scaledSizeOf(0, 0, {.5, .5}).bytes(), 0u);
}

TEST(TransferScale, averagesFourPixelsAtHalfTheSize) {
    const auto pixels = noise(8, 6);
    std::vector<std::byte> small(ScaledSize{4, 3}.bytes());
    resizePicture(pixels.data(), 8, 6, small.data(), 4, 3);
    for (int32_t y = 0; y < 3; ++y)
        for (int32_t x = 0; x < 4; ++x)
            for (int c = 0; c < 4; ++c) {
                const int sum = at(pixels, 8, 2 * x, 2 * y, c) + at(pixels, 8, 2 * x + 1, 2 * y, c) +
                                at(pixels, 8, 2 * x, 2 * y + 1, c) + at(pixels, 8, 2 * x + 1, 2 * y + 1, c);
                EXPECT_EQ(at(small, 4, x, y, c), (sum + 2) / 4);
            }
}

TEST(TransferScale, keepsASingleColour) {
    const std::vector<std::byte> pixels(ScaledSize{13, 7}.bytes(), std::byte{201});
    std::vector<std::byte> other(ScaledSize{29, 3}.bytes());
    resizePicture(pixels.data(), 13, 7, other.data(), 29, 3);
    for (const std::byte b : other) EXPECT_EQ(b, std::byte{201});
}

TEST(TransferScale, keepsAPictureOfTheSameSize) {
    const auto pixels = noise(9, 5);
    std::vector<std::byte> other(pixels.size());
    resizePicture(pixels.data(), 9, 5, other.data(), 9, 5);
    EXPECT_EQ(other, pixels);
}

} // namespace
} // namespace mural
