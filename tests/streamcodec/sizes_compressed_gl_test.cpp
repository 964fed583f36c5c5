// Block formats and their pixel store parameters, compared with GL.
#include "tests/streamcodec/sizes_gl_context.hpp"

#include <cstring>

#include "streamcodec/sizes/compressed_block.hpp"
#include "streamcodec/sizes/gl_enums.hpp"
#include "tests/streamcodec/sizes_guarded_memory.hpp"
#include "tests/streamcodec/sizes_random.hpp"

namespace mural::sizes {
namespace {

// By brute force: GL accepts a compressed image of any size only with the correct imageSize.
int checkImageSizes(GLenum format) {
    const std::vector<uint8_t> data(4096);
    for (const auto& [width, height] : {std::pair{1, 1}, {4, 4}, {5, 9}, {13, 8}, {24, 25}}) {
        const auto size = static_cast<GLsizei>(compressedBytes(format, width, height, 1));
        glCompressedTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, size, data.data());
        if (takeErrors()) return 0;
        glCompressedTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, size + 1, data.data());
        EXPECT_TRUE(takeErrors()) << std::hex << format;
    }
    return 1;
}

void checkFormats(TestApi api, int atLeast) {
    const TestContext context(api);
    if (!context.valid()) GTEST_SKIP() << "no such context over EGL surfaceless here";
    int taken = 0;
    const std::vector<uint8_t> data(4096);
    for (GLenum format = 0; format <= 0xffff; ++format) {
        if (compressedBlock(format).bytes != 0) {
            taken += checkImageSizes(format);
            continue;
        }
        if (format >= GL_PALETTE4_RGB8_OES && format <= GL_PALETTE8_RGB5_A1_OES) continue;
        for (GLsizei size : {8, 16}) {
            glCompressedTexImage2D(GL_TEXTURE_2D, 0, format, 4, 4, 0, size, data.data());
            EXPECT_TRUE(takeErrors()) << "a block format that is missing: " << std::hex << format;
        }
    }
    std::printf("%d compressed formats\n", taken);
    EXPECT_GE(taken, atLeast);
}

TEST(SizesCompressedGl, matchesImageSizes) { checkFormats(TestApi::Compatibility, 10); }
TEST(SizesCompressedGl, matchesImageSizesOfOpenGlEs3) { checkFormats(TestApi::Es3, 10); }

PixelStore randomBlockStore(Random& random, const CompressedBlock& block, int width, int height) {
    PixelStore store;
    store.compressedBlockWidth = static_cast<GLint>(block.width);
    store.compressedBlockHeight = static_cast<GLint>(block.height);
    store.compressedBlockDepth = static_cast<GLint>(block.depth);
    store.compressedBlockSize = static_cast<GLint>(block.bytes);
    const int across = store.compressedBlockWidth;
    const int down = store.compressedBlockHeight;
    if (random.oneIn(2)) {
        store.skipPixels = random.upTo(2) * across;
        store.rowLength = width + store.skipPixels + random.upTo(9);
    }
    if (random.oneIn(2)) store.skipRows = random.upTo(2) * down;
    if (random.oneIn(2)) store.imageHeight = height + random.upTo(9);
    if (random.oneIn(2)) store.skipImages = random.upTo(2);
    return store;
}

class CompressedGl : public testing::Test {
protected:
    // Places bytes so that they end at the guard, and uploads them.
    void load(const std::vector<uint8_t>& bytes, size_t pastTheEnd, const PixelStore& store) {
        setPixelStore(Direction::Unpack, store, TestApi::Compatibility);
        uint8_t* pointer = memory_.end() - bytes.size() + pastTheEnd;
        std::memcpy(pointer, bytes.data(), bytes.size() - pastTheEnd);
        memory_.close();
        glCompressedTexImage3D(GL_TEXTURE_2D_ARRAY, 0, format_, width_, height_, depth_, 0,
                               static_cast<GLsizei>(compressedBytes(format_, width_, height_, depth_)), pointer);
    }
    std::vector<uint8_t> fetch() {
        setPixelStore(Direction::Pack, tightStore(), TestApi::Compatibility);
        std::vector<uint8_t> bytes(compressedBytes(format_, width_, height_, depth_));
        glGetCompressedTexImage(GL_TEXTURE_2D_ARRAY, 0, bytes.data());
        return bytes;
    }

    void checkLoad(const PixelStore& store) {
        const ImageLayout layout = compressedLayoutOf(store, format_, width_, height_, depth_, 3);
        ASSERT_TRUE(layout.known);
        const std::vector<uint8_t> client = random_.bytes(spanBytes(layout));
        std::vector<uint8_t> tight(tightBytes(layout));
        packTight(tight.data(), client.data(), layout);
        load(client, 0, store);
        ASSERT_FALSE(takeErrors());
        EXPECT_FALSE(memory_.touched()) << "GL reads behind spanBytes";
        EXPECT_EQ(fetch(), tight);
        load(client, 1, store);
        EXPECT_TRUE(memory_.touched()) << "GL does not read the last byte of spanBytes";
        load(tight, 0, tightStore());
        EXPECT_FALSE(memory_.touched());
        EXPECT_EQ(fetch(), tight);
    }

    void checkFetch(const PixelStore& store) {
        const ImageLayout layout = compressedLayoutOf(store, format_, width_, height_, depth_, 3);
        ASSERT_TRUE(layout.known);
        std::vector<uint8_t> expected = random_.bytes(spanBytes(layout));
        uint8_t* pointer = memory_.end() - expected.size();
        std::memcpy(pointer, expected.data(), expected.size());
        unpackTight(expected.data(), fetch().data(), layout);
        setPixelStore(Direction::Pack, store, TestApi::Compatibility);
        memory_.close();
        glGetCompressedTexImage(GL_TEXTURE_2D_ARRAY, 0, pointer);
        EXPECT_FALSE(takeErrors());
        EXPECT_FALSE(memory_.touched()) << "GL writes behind spanBytes";
        EXPECT_EQ(std::vector<uint8_t>(pointer, memory_.end()), expected);
    }

    uint32_t seed_ = std::random_device{}();
    Random random_{seed_};
    GuardedMemory memory_{size_t{1} << 19};
    GLenum format_ = 0;
    GLsizei width_ = 0, height_ = 0, depth_ = 0;
};

TEST_F(CompressedGl, uploadsPartsOfLargerImages) {
    const TestContext context(TestApi::Compatibility);
    if (!context.valid()) GTEST_SKIP() << "no compatibility profile over EGL surfaceless here";
    for (GLenum format : {GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_COMPRESSED_RED_RGTC1,
                          GL_COMPRESSED_RGBA_BPTC_UNORM})
        for (int round = 0; round < 40; ++round) {
            format_ = static_cast<GLenum>(format);
            width_ = random_.between(1, 30);
            height_ = random_.between(1, 20);
            depth_ = random_.between(1, 3);
            const PixelStore store = randomBlockStore(random_, compressedBlock(format_), width_, height_);
            SCOPED_TRACE("seed " + std::to_string(seed_) + " " + std::to_string(width_) + "x" +
                         std::to_string(height_) + "x" + std::to_string(depth_) + " " + describe(store));
            checkLoad(store);
            checkFetch(store);
            if (HasFailure()) return;
        }
}

} // namespace
} // namespace mural::sizes
