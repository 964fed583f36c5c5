// The difference filter for pixels and its inverse, with every instruction set.
#include "streamcodec/delta/entropy/pixel_deltas.hpp"

#include <bit>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "tests/common/vector_targets.hpp"

namespace mural::delta {
namespace {

using Bytes = std::vector<std::byte>;

// Runs of equal pixels, slopes and noise.
Bytes pieceOf(uint32_t seed) {
    std::mt19937 random(seed);
    Bytes piece(kPageBytes);
    size_t i = 0;
    while (i < piece.size()) {
        const uint32_t kind = random() % 4, step = random() % 5, period = 1 + random() % 8;
        const auto begin = static_cast<uint32_t>(random());
        for (size_t end = std::min(piece.size(), i + random() % 200), from = i; i < end; ++i)
            piece[i] = static_cast<std::byte>(kind == 0   ? 0u
                                              : kind == 1 ? begin >> (i - from) % period
                                              : kind == 2 ? begin + step * static_cast<uint32_t>(i)
                                                          : random());
    }
    return piece;
}

uint8_t behind(const Bytes& piece, size_t i, size_t pixelBytes) {
    return static_cast<uint8_t>(static_cast<uint8_t>(piece[i]) -
                                (i < pixelBytes ? 0 : static_cast<uint8_t>(piece[i - pixelBytes])));
}

TEST(PixelDeltas, computesAndInvertsByteDifferences) {
    test::forEachTarget([](const char* target) {
        for (uint32_t seed = 0; seed < 40; ++seed) {
            const Bytes piece = pieceOf(seed);
            for (const uint8_t pixelBytes : kPixelFilters) {
                if (pixelBytes == 0 || takesColoursApart(pixelBytes)) continue;
                std::vector<uint32_t> words(kPieceWordRoom), expected;
                Bytes mask(kPieceMaskBytes), expectedMask(kPieceMaskBytes), back(kPageBytes);
                for (size_t w = 0; w < kPieceWords; ++w) {
                    uint32_t word = 0;
                    for (size_t b = 0; b < 4; ++b) word |= uint32_t{behind(piece, 4 * w + b, pixelBytes)} << 8 * b;
                    if (word == 0) continue;
                    expected.push_back(word);
                    expectedMask[w / 8] |= static_cast<std::byte>(1 << w % 8);
                }
                words.resize(differences(piece.data(), pixelBytes, words.data(), mask.data()));
                ASSERT_EQ(words, expected) << target << " seed " << seed << " pixels of " << +pixelBytes;
                ASSERT_EQ(mask, expectedMask) << target << " seed " << seed << " pixels of " << +pixelBytes;
                words.push_back(0);
                ASSERT_EQ(sumDifferences(words.data(), mask.data(), pixelBytes, back.data()), expected.size());
                ASSERT_EQ(back, piece) << target << " seed " << seed << " pixels of " << +pixelBytes;
            }
        }
    });
}

TEST(PixelDeltas, measuresEqualRoughnessWithAllInstructionSets) {
    for (uint32_t seed = 0; seed < 40; ++seed) {
        const Bytes piece = pieceOf(seed);
        const auto first = roughness(piece.data());
        test::forEachTarget(
            [&](const char* target) { EXPECT_EQ(roughness(piece.data()), first) << target << " seed " << seed; });
    }
}

TEST(PixelDeltas, findsThePixelSizeOfASlope) {
    for (size_t k = 1; k < kByteFilters; ++k) {
        const size_t pixelBytes = kPixelFilters[k];
        Bytes piece(kPageBytes);
        for (size_t i = 0; i < piece.size(); ++i)
            piece[i] = static_cast<std::byte>(i % pixelBytes * 67 + 90 + (i / pixelBytes) % 2 * (k % 2));
        const auto rough = roughness(piece.data());
        for (size_t other = 0; other < k; ++other)
            EXPECT_LT(rough[k], rough[other]) << pixelBytes << " beside " << +kPixelFilters[other];
    }
}

// Random brightness of one hue: only the common part of the channels changes.
TEST(PixelDeltas, subtractsTheCommonPartForPixelsOfOneHue) {
    for (size_t k = kByteFilters; k < kPixelFilters.size(); ++k) {
        const size_t pixelBytes = kPixelFilters[k] == kColoursOfFour ? 4 : 3,
                     before = pixelBytes == 4 ? 0 : k - kByteFilters - 1;
        std::mt19937 random(5);
        Bytes piece(kPageBytes);
        uint32_t bright = 0;
        for (size_t i = 0; i < piece.size(); ++i) {
            const size_t colour = (i + 3 * pixelBytes - before) % pixelBytes;
            if (colour == 0) bright = static_cast<uint32_t>(random() % 20);
            piece[i] = colour == 3 ? std::byte{255} : static_cast<std::byte>(90 + 40 * colour + bright);
        }
        const auto rough = roughness(piece.data());
        for (size_t other = 0; other < kPixelFilters.size(); ++other) {
            if (other == k) continue;
            EXPECT_LT(rough[k] * 3, rough[other] * 2) << +kPixelFilters[k] << " beside " << +kPixelFilters[other];
        }
    }
}

TEST(PixelDeltas, roundTripsPlanesOfAnyLength) {
    test::forEachTarget([](const char* target) {
        std::mt19937 random(7);
        for (size_t count = 0; count < 300; ++count) {
            std::vector<uint32_t> words(count), back(count);
            for (auto& w : words) w = static_cast<uint32_t>(random());
            Bytes planes(4 * count);
            toPlanes(words.data(), count, planes.data());
            for (size_t i = 0; i < count; ++i)
                for (size_t p = 0; p < 4; ++p)
                    ASSERT_EQ(static_cast<uint8_t>(planes[p * count + i]), static_cast<uint8_t>(words[i] >> 8 * p))
                        << target << ' ' << count;
            fromPlanes(planes.data(), count, back.data());
            ASSERT_EQ(back, words) << target << ' ' << count;
        }
    });
}

} // namespace
} // namespace mural::delta
