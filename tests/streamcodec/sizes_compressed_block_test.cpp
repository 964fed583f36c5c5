// Sizes of compressed images and of their blocks.
#include <gtest/gtest.h>

#include "streamcodec/sizes/compressed_block.hpp"
#include "streamcodec/sizes/gl_enums.hpp"
#include "tests/streamcodec/sizes_random.hpp"

namespace mural::sizes {
namespace {

void expectBlock(GLenum format, uint32_t width, uint32_t height, uint32_t depth, uint32_t bytes) {
    const CompressedBlock block = compressedBlock(format);
    EXPECT_EQ(block.width, width) << std::hex << format;
    EXPECT_EQ(block.height, height) << std::hex << format;
    EXPECT_EQ(block.depth, depth) << std::hex << format;
    EXPECT_EQ(block.bytes, bytes) << std::hex << format;
}

TEST(SizesCompressedBlock, supportsBlockShapes) {
    expectBlock(GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 4, 4, 1, 8);
    expectBlock(GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT, 4, 4, 1, 16);
    expectBlock(GL_COMPRESSED_RED_RGTC1, 4, 4, 1, 8);
    expectBlock(GL_COMPRESSED_RGBA_BPTC_UNORM, 4, 4, 1, 16);
    expectBlock(GL_COMPRESSED_RGB8_ETC2, 4, 4, 1, 8);
    expectBlock(GL_COMPRESSED_RGBA8_ETC2_EAC, 4, 4, 1, 16);
    expectBlock(GL_COMPRESSED_RGB_FXT1_3DFX, 8, 4, 1, 16);
    expectBlock(GL_COMPRESSED_RGBA_ASTC_4x4_KHR, 4, 4, 1, 16);
    expectBlock(GL_COMPRESSED_RGBA_ASTC_10x6_KHR, 10, 6, 1, 16);
    expectBlock(GL_COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR, 12, 12, 1, 16);
    expectBlock(GL_COMPRESSED_RGBA_ASTC_6x5x5_OES, 6, 5, 5, 16);
    expectBlock(GL_COMPRESSED_SRGB8_ALPHA8_ASTC_6x6x6_OES, 6, 6, 6, 16);
    expectBlock(GL_COMPRESSED_RGBA_PVRTC_2BPPV1_IMG, 8, 4, 1, 8);
    expectBlock(GL_RGBA8, 0, 0, 0, 0);
    expectBlock(GL_PALETTE4_RGB8_OES, 0, 0, 0, 0);
}

TEST(SizesCompressedBlock, computesImageSizes) {
    EXPECT_EQ(compressedBytes(GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 5, 5, 1), 32u);
    EXPECT_EQ(compressedBytes(GL_COMPRESSED_RGBA_ASTC_8x5_KHR, 17, 11, 2), 3u * 3 * 2 * 16);
    EXPECT_EQ(compressedBytes(GL_COMPRESSED_RGBA_ASTC_3x3x3_OES, 4, 4, 4), 8u * 16);
    EXPECT_EQ(compressedBytes(GL_COMPRESSED_RGB_PVRTC_4BPPV1_IMG, 4, 4, 1),
              32u); // at least 2×2 blocks
    EXPECT_EQ(compressedBytes(GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 0, 5, 1), 0u);
    EXPECT_EQ(compressedBytes(GL_RGBA8, 4, 4, 1), 0u);
    EXPECT_EQ(compressedBytes(GL_COMPRESSED_RGBA_ASTC_4x4_KHR, INT32_MAX, INT32_MAX, INT32_MAX), SIZE_MAX);
}

TEST(SizesCompressedBlock, isTightWithoutBlockSettings) {
    PixelStore store;
    store.rowLength = 100;
    store.skipRows = 3;
    const ImageLayout layout = compressedLayoutOf(store, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, 9, 6, 2, 3);
    ASSERT_TRUE(layout.known);
    EXPECT_EQ(layout.firstByte, 0);
    EXPECT_EQ(spanBytes(layout), 3u * 2 * 2 * 16);
    EXPECT_EQ(tightBytes(layout), spanBytes(layout));
}

TEST(SizesCompressedBlock, selectsAPartOfALargerImage) {
    PixelStore store;
    store.compressedBlockWidth = store.compressedBlockHeight = 4;
    store.compressedBlockDepth = 1;
    store.compressedBlockSize = 8;
    store.rowLength = 22;   // 6 blocks
    store.imageHeight = 13; // 4 rows
    store.skipPixels = 8;   // 2 blocks
    store.skipRows = 4;     // 1 row
    store.skipImages = 1;
    const ImageLayout layout = compressedLayoutOf(store, GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 8, 8, 2, 3);
    ASSERT_TRUE(layout.known);
    EXPECT_EQ(layout.rowBytes, 16u);
    EXPECT_EQ(layout.rows, 2u);
    EXPECT_EQ(layout.firstByte, 4 * 48 + 48 + 16);
    EXPECT_EQ(spanBytes(layout), static_cast<size_t>(4 * 48 + 48 + 16 + 4 * 48 + 48 + 16));

    Random random(7);
    const std::vector<uint8_t> client = random.bytes(spanBytes(layout));
    std::vector<uint8_t> tight(tightBytes(layout));
    packTight(tight.data(), client.data(), layout);
    std::vector<uint8_t> again(client.size(), 0);
    unpackTight(again.data(), tight.data(), layout);
    for (size_t image = 0; image < 2; ++image)
        for (size_t row = 0; row < 2; ++row)
            for (size_t b = 0; b < 16; ++b) {
                const size_t at = 4 * 48 + 48 + 16 + image * 4 * 48 + row * 48 + b;
                EXPECT_EQ(tight[(image * 2 + row) * 16 + b], client[at]);
                EXPECT_EQ(again[at], client[at]);
            }
}

TEST(SizesCompressedBlock, doesNotWrapHugeSettings) {
    PixelStore store;
    store.compressedBlockWidth = store.compressedBlockHeight = store.compressedBlockDepth = 1;
    store.compressedBlockSize = store.rowLength = store.imageHeight = store.skipImages = INT32_MAX;
    EXPECT_FALSE(compressedLayoutOf(store, GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 8, 8, 2, 3).known);
}

} // namespace
} // namespace mural::sizes
