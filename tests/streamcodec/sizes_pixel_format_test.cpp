// Sizes of pixels by format and type.
#include <gtest/gtest.h>

#include "streamcodec/sizes/gl_enums.hpp"
#include "streamcodec/sizes/pixel_format.hpp"

namespace mural::sizes {
namespace {

TEST(SizesPixelFormat, countsComponents) {
    EXPECT_EQ(componentsOf(GL_RED), 1u);
    EXPECT_EQ(componentsOf(GL_COLOR_INDEX), 1u);
    EXPECT_EQ(componentsOf(GL_LUMINANCE_ALPHA), 2u);
    EXPECT_EQ(componentsOf(GL_RG_INTEGER), 2u);
    EXPECT_EQ(componentsOf(GL_DEPTH_STENCIL), 2u);
    EXPECT_EQ(componentsOf(GL_BGR_INTEGER), 3u);
    EXPECT_EQ(componentsOf(GL_ABGR_EXT), 4u);
    EXPECT_EQ(componentsOf(GL_CMYKA_EXT), 5u);
    EXPECT_EQ(componentsOf(GL_RGBA8), 0u);
    EXPECT_EQ(componentsOf(0), 0u);
}

TEST(SizesPixelFormat, computesBytesOfPlainPixels) {
    EXPECT_EQ(groupBytes(GL_RGB, GL_UNSIGNED_BYTE), 3u);
    EXPECT_EQ(groupBytes(GL_RGBA, GL_FLOAT), 16u);
    EXPECT_EQ(groupBytes(GL_RGB_INTEGER, GL_SHORT), 6u);
    EXPECT_EQ(groupBytes(GL_RG, GL_HALF_FLOAT), 4u);
    EXPECT_EQ(groupBytes(GL_RGBA, GL_HALF_FLOAT_OES), 8u);
    EXPECT_EQ(groupBytes(GL_DEPTH_COMPONENT, GL_UNSIGNED_INT), 4u);
    EXPECT_EQ(groupBytes(GL_CMYKA_EXT, GL_FLOAT), 20u);
    EXPECT_EQ(groupBytes(GL_422_EXT, GL_UNSIGNED_BYTE), 2u);
}

TEST(SizesPixelFormat, computesBytesOfPackedPixels) {
    EXPECT_EQ(groupBytes(GL_RGB, GL_UNSIGNED_BYTE_2_3_3_REV), 1u);
    EXPECT_EQ(groupBytes(GL_RGB, GL_UNSIGNED_SHORT_5_6_5), 2u);
    EXPECT_EQ(groupBytes(GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV), 2u);
    EXPECT_EQ(groupBytes(GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV), 4u);
    EXPECT_EQ(groupBytes(GL_RGBA_INTEGER, GL_UNSIGNED_INT_2_10_10_10_REV), 4u);
    EXPECT_EQ(groupBytes(GL_RGB, GL_UNSIGNED_INT_2_10_10_10_REV), 4u);
    EXPECT_EQ(groupBytes(GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV), 4u);
    EXPECT_EQ(groupBytes(GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV), 4u);
    EXPECT_EQ(groupBytes(GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8), 4u);
    EXPECT_EQ(groupBytes(GL_DEPTH_COMPONENT, GL_UNSIGNED_INT_24_8), 4u); // NV_read_depth
    EXPECT_EQ(groupBytes(GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV), 8u);
    EXPECT_EQ(groupBytes(GL_YCBCR_MESA, GL_UNSIGNED_SHORT_8_8_REV_MESA), 2u);
    EXPECT_EQ(groupBytes(GL_RGB_422_APPLE, GL_UNSIGNED_SHORT_8_8_APPLE), 2u);
}

TEST(SizesPixelFormat, returnsZeroForInvalidPairs) {
    EXPECT_EQ(groupBytes(GL_RGB, GL_UNSIGNED_SHORT_4_4_4_4), 0u);
    EXPECT_EQ(groupBytes(GL_RGBA, GL_UNSIGNED_SHORT_5_6_5), 0u);
    EXPECT_EQ(groupBytes(GL_DEPTH_STENCIL, GL_UNSIGNED_BYTE), 0u);
    EXPECT_EQ(groupBytes(GL_DEPTH_COMPONENT, GL_FLOAT_32_UNSIGNED_INT_24_8_REV), 0u);
    EXPECT_EQ(groupBytes(GL_RG, GL_UNSIGNED_INT_24_8), 0u);
    EXPECT_EQ(groupBytes(GL_RG, GL_UNSIGNED_SHORT_8_8_MESA), 0u);
    EXPECT_EQ(groupBytes(GL_COLOR_INDEX, GL_BITMAP), 0u);
    EXPECT_EQ(groupBytes(GL_RGBA, GL_DOUBLE), 0u);
    EXPECT_EQ(groupBytes(GL_RGBA8, GL_UNSIGNED_BYTE), 0u);
}

TEST(SizesPixelFormat, findsSwapUnits) {
    EXPECT_EQ(swapUnitBytes(GL_BYTE), 1u);
    EXPECT_EQ(swapUnitBytes(GL_HALF_FLOAT), 2u);
    EXPECT_EQ(swapUnitBytes(GL_UNSIGNED_SHORT_5_5_5_1), 2u);
    EXPECT_EQ(swapUnitBytes(GL_UNSIGNED_INT_8_8_8_8), 4u);
    EXPECT_EQ(swapUnitBytes(GL_FLOAT_32_UNSIGNED_INT_24_8_REV), 4u);
    EXPECT_EQ(swapUnitBytes(GL_BITMAP), 1u);
    EXPECT_EQ(swapUnitBytes(0x1234), 0u);
}

} // namespace
} // namespace mural::sizes
