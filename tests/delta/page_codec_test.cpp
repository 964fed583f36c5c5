// The section of new pages: round trips, filtered pictures, damaged input.
#include "streamcodec/delta/entropy/page_codec.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

#include "streamcodec/delta/varint.hpp"

namespace mural::delta {
namespace {

using Bytes = std::vector<std::byte>;

Bytes operator+(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

// A photograph for a compressor's purposes: colours that change gradually, constant alpha.
Bytes picture(size_t sizeBytes, size_t pixelBytes, uint32_t seed) {
    std::mt19937 random(seed);
    Bytes bytes(sizeBytes);
    for (size_t i = 0; i < bytes.size(); ++i) {
        const auto before = i < pixelBytes ? 128u : static_cast<uint32_t>(bytes[i - pixelBytes]);
        bytes[i] = static_cast<std::byte>(pixelBytes == 4 && i % 4 == 3 ? 255 : before + random() % 7 - 3);
    }
    return bytes;
}

Bytes vertices(size_t sizeBytes, uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<float> some(300), floats;
    for (auto& f : some) f = static_cast<float>(random()) / 1e9f;
    while (floats.size() * 4 < sizeBytes)
        floats.insert(floats.end(), some.begin() + static_cast<std::ptrdiff_t>(random() % 100) * 3, some.end());
    Bytes bytes(sizeBytes);
    if (sizeBytes > 0) std::memcpy(bytes.data(), floats.data(), sizeBytes);
    return bytes;
}

// Black glyphs on white, four bytes per pixel, 8 per line, of `kinds` different shapes.
Bytes signs(size_t sizeBytes, uint32_t kinds, uint32_t seed) {
    constexpr size_t kWidth = 16, kHeight = 8, kSigns = 8, kLine = kWidth * kSigns;
    std::mt19937 random(seed);
    std::vector<std::array<uint8_t, kWidth * kHeight>> shapes(kinds);
    for (auto& shape : shapes)
        for (auto& pixel : shape) pixel = random() % 12 == 0 ? static_cast<uint8_t>(random()) : 255;
    Bytes bytes(sizeBytes, std::byte{255});
    std::vector<uint32_t> line(kSigns);
    for (size_t pixel = 0; pixel * 4 < sizeBytes; ++pixel) {
        const size_t x = pixel % kLine, y = pixel / kLine;
        if (x == 0 && y % kHeight == 0)
            std::ranges::generate(line, [&] { return static_cast<uint32_t>(random()) % kinds; });
        if (y / kHeight % 2 == 1) continue; // between lines
        std::memset(bytes.data() + pixel * 4, shapes[line[x / kWidth]][y % kHeight * kWidth + x % kWidth], 3);
    }
    return bytes;
}

size_t compressedBytes(const Bytes& bytes) {
    Bytes coded;
    EXPECT_TRUE(PageCompressor().compress(Coding::Zstd, bytes, coded));
    return coded.size();
}

size_t plainBytes(const Bytes& bytes) {
    Bytes coded;
    EXPECT_TRUE(SectionCompressor(2).compress(Coding::Zstd, bytes, coded));
    return coded.size();
}

TEST(PageCodec, roundTripsAnyPagesWithBothCodings) {
    for (const Coding coding : {Coding::Zstd, Coding::Lz4}) {
        PageCompressor compressor;
        PageDecompressor decompressor;
        for (uint32_t round = 0; round < 60; ++round) {
            Bytes bytes;
            std::mt19937 random(round);
            for (uint32_t parts = random() % 5; parts < 6; ++parts) {
                const size_t sizeBytes = random() % 4 * kPageBytes + (random() % 3 == 0 ? random() % 1000 * 4 : 0);
                constexpr size_t kPixels[] = {1, 2, 3, 4, 8};
                bytes = bytes + (random() % 3 == 0   ? vertices(sizeBytes, round)
                                 : random() % 5 == 0 ? Bytes(sizeBytes, static_cast<std::byte>(random()))
                                                     : picture(sizeBytes, kPixels[random() % 5], round));
            }
            if (bytes.empty()) continue;
            Bytes coded, back(bytes.size());
            ASSERT_TRUE(compressor.compress(coding, bytes, coded));
            ASSERT_TRUE(decompressor.decompress(coding, coded, back)) << round;
            ASSERT_TRUE(back == bytes) << round;
        }
    }
}

TEST(PageCodec, reducesPicturesAndKeepsTheSizeOfVertices) {
    for (const size_t pixelBytes : {1, 3, 4}) {
        const Bytes bytes = picture(64 * kPageBytes, pixelBytes, 1);
        EXPECT_LT(compressedBytes(bytes), plainBytes(bytes) * 8 / 10) << pixelBytes;
    }
    const Bytes floats = vertices(64 * kPageBytes, 2);
    EXPECT_LE(compressedBytes(floats), plainBytes(floats) + 1);
}

// With two glyphs Zstandard finds more in the original; with many, differences are smaller.
TEST(PageCodec, leavesRepetitivePicturesUnchanged) {
    const Bytes few = signs(48 * kPageBytes, 2, 7), many = signs(48 * kPageBytes, 400, 8);
    EXPECT_FALSE(PixelFilterEncoder().split(few));
    EXPECT_LE(compressedBytes(few), plainBytes(few) + 1);
    EXPECT_TRUE(PixelFilterEncoder().split(many));
    EXPECT_LT(compressedBytes(many), plainBytes(many));
}

// Grey pictures with three bytes per pixel cost about as much as one channel, wherever a page starts within a pixel.
// Returns whether planes are coded by frequencies.
bool isCounted(const Bytes& coded) {
    std::span<const std::byte> at = coded;
    uint32_t pieces = 0, front = 0, planes = 0;
    return readVarint(at, pieces) && readVarint(at, front) && readVarint(at, planes) && (planes & 1) != 0;
}

TEST(PageCodec, searchesForRepetitionsWhereTheyExist) {
    const Bytes photograph = picture(16 * kPageBytes, 4, 1);
    Bytes lines;
    while (lines.size() < 16 * kPageBytes) lines = lines + picture(600, 4, 2);
    lines.resize(16 * kPageBytes);
    for (const Bytes& bytes : {photograph, lines}) {
        Bytes coded, out(bytes.size());
        PageCompressor compressor;
        ASSERT_TRUE(compressor.compress(Coding::Zstd, bytes, coded));
        EXPECT_EQ(isCounted(coded), bytes == photograph);
        EXPECT_LE(coded.size(), bytes.size() / (bytes == photograph ? 3 : 20));
        ASSERT_TRUE(PageDecompressor().decompress(Coding::Zstd, coded, out));
        EXPECT_EQ(out, bytes);
    }
}

TEST(PageCodec, encodesGreyPicturesOfThreeBytesLikeOneChannel) {
    const Bytes one = picture(64 * kPageBytes, 1, 6);
    Bytes three;
    for (const std::byte b : one) three.insert(three.end(), 3, b);
    for (size_t before = 0; before < 3; ++before) {
        const Bytes bytes(three.begin() + static_cast<std::ptrdiff_t>(before),
                          three.end() - static_cast<std::ptrdiff_t>(3 - before));
        EXPECT_LT(compressedBytes(bytes), compressedBytes(one) * 12 / 10) << before;
    }
}

TEST(PageCodec, needsNoPlanesForUniformPages) {
    Bytes bytes;
    for (uint32_t i = 0; i < 16; ++i) bytes = bytes + Bytes(kPageBytes, static_cast<std::byte>(100 + i));
    Bytes coded, back(bytes.size());
    ASSERT_TRUE(PageCompressor().compress(Coding::Zstd, bytes, coded));
    EXPECT_LT(coded.size(), 200u);
    ASSERT_TRUE(PageDecompressor().decompress(Coding::Zstd, coded, back));
    EXPECT_TRUE(back == bytes);
}

// Corrupt data is rejected or decodes to other bytes, never beyond the buffer.
TEST(PageCodec, survivesChangedAndTruncatedBytes) {
    const Bytes bytes = picture(3 * kPageBytes, 4, 3) + vertices(2 * kPageBytes + 400, 3) + picture(kPageBytes, 3, 4);
    Bytes coded, back(bytes.size());
    ASSERT_TRUE(PageCompressor().compress(Coding::Zstd, bytes, coded));
    ASSERT_TRUE(PageDecompressor().decompress(Coding::Zstd, coded, back));
    ASSERT_TRUE(back == bytes);
    for (size_t size = 0; size < coded.size(); size += 1 + size / 50)
        EXPECT_FALSE(PageDecompressor().decompress(Coding::Zstd, std::span(coded).first(size), back)) << size;
    size_t refused = 0, other = 0;
    for (size_t at = 0; at < coded.size(); at += 1 + at / 50) {
        Bytes changed = coded;
        changed[at] ^= std::byte{0x41};
        Bytes into(bytes.size());
        if (!PageDecompressor().decompress(Coding::Zstd, changed, into))
            ++refused;
        else
            other += into != bytes;
    }
    EXPECT_GT(refused, 20u);
    EXPECT_GT(other, 20u);
    for (const size_t size :
         {size_t{0}, size_t{4}, kPageBytes, bytes.size() - kPageBytes, bytes.size() - 4, bytes.size() + 4}) {
        Bytes into(size);
        EXPECT_FALSE(PageDecompressor().decompress(Coding::Zstd, coded, into)) << size;
    }
}

} // namespace
} // namespace mural::delta
