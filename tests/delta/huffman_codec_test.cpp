// Coding by byte frequencies for data with few repetitions.
#include "streamcodec/delta/entropy/huffman_codec.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace mural::delta {
namespace {

using Bytes = std::vector<std::byte>;

// Like the residual of a photograph: small numbers with different frequencies.
Bytes left(size_t sizeBytes, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> values(0, 6);
    Bytes bytes(sizeBytes);
    for (std::byte& b : bytes) b = static_cast<std::byte>(static_cast<int>(std::lround(values(random))));
    return bytes;
}

Bytes repeated(const Bytes& bytes, size_t sizeBytes) {
    Bytes all;
    while (all.size() < sizeBytes) all.insert(all.end(), bytes.begin(), bytes.end());
    all.resize(sizeBytes);
    return all;
}

TEST(HuffmanCodec, roundTripsAllData) {
    HuffmanCompressor compressor;
    HuffmanDecompressor decompressor;
    for (const Bytes& bytes : {Bytes{}, left(1, 1), left(300, 2), left(5000, 3), left(700'000, 4),
                               repeated(left(100, 5), 9000), Bytes(4096, std::byte{7})}) {
        Bytes coded{std::byte{1}}, out(bytes.size());
        ASSERT_TRUE(compressor.compress(bytes, coded));
        ASSERT_TRUE(decompressor.decompress(std::span(coded).subspan(1), out)) << bytes.size();
        EXPECT_EQ(out, bytes);
        Bytes more(bytes.size() + 1);
        EXPECT_FALSE(decompressor.decompress(std::span(coded).subspan(1), more)) << bytes.size();
        EXPECT_FALSE(decompressor.decompress(std::span(coded).subspan(1, coded.size() - 2), out)) << bytes.size();
    }
}

// The codes are within 1 % of the entropy plus the table: 4.63 bits for each of these.
TEST(HuffmanCodec, approachesTheEntropy) {
    HuffmanCompressor compressor;
    Bytes coded;
    ASSERT_TRUE(compressor.compress(left(100'000, 6), coded));
    EXPECT_NEAR(static_cast<double>(coded.size()), 100'000 * 4.63 / 8, 900);
}

TEST(HuffmanCodec, suitsUnevenFrequenciesWithoutRepetitions) {
    HuffmanCompressor compressor;
    EXPECT_TRUE(compressor.suits(left(100'000, 7)));
    EXPECT_TRUE(compressor.suits(left(4096, 7)));
    EXPECT_FALSE(compressor.suits(left(4095, 7))); // too short to decide
    EXPECT_FALSE(compressor.suits({}));
    EXPECT_FALSE(compressor.suits(repeated(left(200, 8), 100'000)));
    EXPECT_FALSE(compressor.suits(Bytes(100'000, std::byte{0})));
    Bytes random(100'000);
    std::mt19937 any(9);
    for (std::byte& b : random) b = static_cast<std::byte>(any());
    EXPECT_FALSE(compressor.suits(random)); // incompressible
}

} // namespace
} // namespace mural::delta
