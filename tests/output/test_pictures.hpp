// Noise pictures, in which every shift, flip, swapped channel or rounding is visible.
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

#include "nodes/output/picture.hpp"

namespace mural::test {

inline OwnedPicture noisePicture(int width, int height, uint32_t seed) {
    OwnedPicture picture(width, height);
    uint32_t state = seed * 2654435761U + 1;
    for (int y = 0; y < height; ++y)
        for (size_t i = 0; i < picture.rowBytes(); ++i) {
            state = state * 1664525U + 1013904223U;
            picture.row(y)[i] = static_cast<std::byte>(state >> 24);
        }
    return picture;
}

inline void setPixel(OwnedPicture& picture, int x, int y, int red, int green, int blue) {
    std::byte* pixel = picture.row(y) + static_cast<size_t>(x) * kPictureBytesPerPixel;
    pixel[0] = static_cast<std::byte>(blue);
    pixel[1] = static_cast<std::byte>(green);
    pixel[2] = static_cast<std::byte>(red);
    pixel[3] = std::byte{0};
}

inline OwnedPicture plainPicture(int width, int height, int red, int green, int blue) {
    OwnedPicture picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) setPixel(picture, x, y, red, green, blue);
    return picture;
}

// For EXPECT_TRUE: reports the number of differing pixels, the maximum difference and the position.
inline testing::AssertionResult samePictures(const Picture& expected, const Picture& actual) {
    const PictureDifference difference = comparePictures(expected, actual);
    if (difference.same()) return testing::AssertionSuccess();
    return testing::AssertionFailure() << describe(difference, expected, actual);
}

} // namespace mural::test
