// Encoding of transferred pictures with every codec.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "nodes/frame_transfer/picture_packer.hpp"
#include "nodes/frame_transfer/picture_unpacker.hpp"

namespace mural {
namespace {

using Pixels = std::vector<std::byte>;

constexpr int32_t kWidth = 531, kHeight = 143; // neither is a multiple of the tile size

// Returns a colour gradient, with noise if `noisy`.
Pixels drawn(int32_t width, int32_t height, unsigned seed, bool noisy = true) {
    std::mt19937 random(seed);
    Pixels pixels(static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
    for (int32_t y = 0; y < height; ++y)
        for (int32_t x = 0; x < width; ++x) {
            std::byte* p = &pixels[4 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x))];
            const bool noise = noisy && y < height / 4;
            p[0] = static_cast<std::byte>(noise ? random() : static_cast<unsigned>(x) / 3 + seed);
            p[1] = static_cast<std::byte>(noise ? random() : static_cast<unsigned>(y));
            p[2] = static_cast<std::byte>(noise ? random() : 200u);
            p[3] = std::byte{255};
        }
    return pixels;
}

struct Ends {
    explicit Ends(const std::string& codec) : packer(codec), unpacker(codec) {}
    // Packs and unpacks a picture, and stores its packed size.
    Pixels through(uint32_t client, uint32_t window, int32_t width, int32_t height, const Pixels& pixels) {
        auto packed = packer.pack(client, window, width, height, pixels.data());
        EXPECT_TRUE(packed);
        size = packed->size();
        Pixels out(pixels.size());
        const auto done = unpacker.unpack(client, window, width, height, *packed, out);
        EXPECT_TRUE(done) << done.error().message;
        return out;
    }
    PicturePacker packer;
    PictureUnpacker unpacker;
    size_t size = 0;
};

class EveryLosslessCodec : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryLosslessCodec, restoresPictures) {
    Ends ends(GetParam());
    for (unsigned i = 0; i < 6; ++i) {
        const Pixels one = drawn(kWidth, kHeight, i), other = drawn(64, 700, i);
        EXPECT_EQ(ends.through(1, 7, kWidth, kHeight, one), one) << i;
        EXPECT_EQ(ends.through(2, 7, 64, 700, other), other) << i;
    }
    const Pixels resized = drawn(3, 1, 9);
    EXPECT_EQ(ends.through(1, 7, 3, 1, resized), resized);
}

INSTANTIATE_TEST_SUITE_P(Codecs, EveryLosslessCodec,
                         ::testing::Values("auto", "raw", "rle64", "bitplane", "bitplane-zstd", "lz4", "zstd"));

// Codecs treat words of 10 bits per component like any other words.
TEST_P(EveryLosslessCodec, restoresDeepPixels) {
    Ends ends(GetParam());
    Pixels pixels(static_cast<size_t>(kWidth) * kHeight * 4);
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
        const uint32_t word = (i % 4) << 30 | (i % 1024) << 20 | (i / 7 % 1024) << 10 | (i * 3 % 1024);
        std::memcpy(&pixels[4 * size_t{i}], &word, 4);
    }
    EXPECT_EQ(ends.through(1, 1, kWidth, kHeight, pixels), pixels);
}

TEST(PackedPictures, skipUnchangedTiles) {
    Ends ends("auto");
    Pixels pixels = drawn(kWidth, kHeight, 1);
    (void)ends.through(1, 1, kWidth, kHeight, pixels);
    const size_t whole = ends.size;
    (void)ends.through(1, 1, kWidth, kHeight, pixels);
    EXPECT_LT(ends.size, 16u);
    pixels[4 * (static_cast<size_t>(kWidth) * 100 + 300)] ^= std::byte{1};
    EXPECT_EQ(ends.through(1, 1, kWidth, kHeight, pixels), pixels);
    EXPECT_LT(ends.size, whole / 4);
    EXPECT_EQ(ends.packer.rawBytes(), 3 * pixels.size());
}

// Returns the largest difference of a colour component.
int farthest(const Pixels& a, const Pixels& b) {
    int maximum = 0;
    for (size_t i = 0; i < a.size(); ++i)
        if (i % 4 != 3) maximum = std::max(maximum, std::abs(static_cast<int>(a[i]) - static_cast<int>(b[i])));
    return maximum;
}

TEST(PackedPictures, haveSmallErrorsForSmoothPicturesWithLossyCodecs) {
    for (const char* codec : {"yuv420", "jpeg-95", "jpeg-90", "lossy"}) {
        Ends ends(codec);
        const Pixels pixels = drawn(kWidth, kHeight, 3, false);
        const Pixels out = ends.through(1, 1, kWidth, kHeight, pixels);
        EXPECT_LE(farthest(pixels, out), 12) << codec; // red swapped with blue differs by 100 or more
    }
    Ends ends("jpeg-50");
    EXPECT_NE(ends.through(1, 1, kWidth, kHeight, drawn(kWidth, kHeight, 3)), drawn(kWidth, kHeight, 3))
        << "noise does not come through";
}

TEST(PackedPictures, keepAlphaWithLossyCodecsUnlessDropped) {
    Pixels pixels = drawn(kWidth, kHeight, 3, false);
    for (size_t i = 0; i < pixels.size(); i += 4) pixels[i + 3] = static_cast<std::byte>(i / 4 * 7);
    for (const char* codec : {"yuv420", "jpeg-95", "lossy"}) {
        Ends ends(codec);
        const Pixels out = ends.through(1, 1, kWidth, kHeight, pixels);
        for (size_t i = 3; i < pixels.size(); i += 4) ASSERT_EQ(out[i], pixels[i]) << codec << ", pixel " << i / 4;
        PicturePacker packer(codec, PictureAlpha::Dropped);
        auto packed = packer.pack(1, 1, kWidth, kHeight, pixels.data());
        ASSERT_TRUE(packed);
        EXPECT_LT(packed->size(), ends.size) << codec << ": alpha costs nothing where nobody sees it";
    }
}

TEST(PackedPictures, restartAfterAWindowIsClosed) {
    Ends ends("zstd");
    const Pixels pixels = drawn(kWidth, kHeight, 1);
    (void)ends.through(1, 1, kWidth, kHeight, pixels);
    ends.packer.windowGone(1, 1);
    ends.unpacker.windowGone(1, 1);
    EXPECT_EQ(ends.through(1, 1, kWidth, kHeight, pixels), pixels);
    ends.packer.clientGone(1);
    ends.unpacker.clientGone(1);
    EXPECT_EQ(ends.through(1, 1, kWidth, kHeight, pixels), pixels);
}

TEST(PackedPictures, rejectDamagedData) {
    PicturePacker packer("bitplane");
    const Pixels pixels = drawn(kWidth, kHeight, 1);
    auto packed = packer.pack(1, 1, kWidth, kHeight, pixels.data());
    ASSERT_TRUE(packed);
    const Pixels bytes(packed->begin(), packed->end());
    Pixels out(pixels.size());
    for (const size_t size : {size_t{0}, size_t{1}, size_t{8}, bytes.size() / 2, bytes.size() - 1}) {
        PictureUnpacker unpacker("bitplane");
        EXPECT_FALSE(unpacker.unpack(1, 1, kWidth, kHeight, std::span(bytes).first(size), out)) << size;
    }
    std::mt19937 random(5);
    for (int i = 0; i < 300; ++i) { // any result is accepted, but no other memory is written
        Pixels bad = bytes;
        for (int k = 0; k < 3; ++k) bad[random() % bad.size()] = static_cast<std::byte>(random());
        PictureUnpacker unpacker("bitplane");
        (void)unpacker.unpack(1, 1, kWidth, kHeight, bad, out);
    }
    PictureUnpacker late("bitplane"); // lacks the first picture
    auto second = packer.pack(1, 1, kWidth, kHeight, pixels.data());
    ASSERT_TRUE(second);
    EXPECT_FALSE(late.unpack(1, 1, kWidth, kHeight, *second, out));
    EXPECT_FALSE(late.unpack(1, 1, 0, kHeight, *second, {}));
}

TEST(WantedCodec, acceptsKnownNames) {
    ASSERT_TRUE(wantedCodec("auto"));
    EXPECT_TRUE(wantedCodec("auto")->chosen && wantedCodec("auto")->lossless);
    EXPECT_FALSE(wantedCodec("lossy")->lossless);
    EXPECT_TRUE(wantedCodec("zstd")->lossless);
    EXPECT_FALSE(wantedCodec("jpeg-80")->lossless);
    EXPECT_FALSE(wantedCodec("jpeg-0"));
    EXPECT_FALSE(wantedCodec("nothing of the kind"));
}

} // namespace
} // namespace mural
