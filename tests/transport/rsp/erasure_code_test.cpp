// The erasure code and its field arithmetic.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "common/base/little_endian.hpp"
#include "transport/rsp/erasure/erasure_code.hpp"
#include "transport/rsp/erasure/gf256.hpp"

namespace mural::rsp {
namespace {

using Bytes = std::vector<std::byte>;

Bytes randomBytes(std::mt19937& random, size_t count) {
    Bytes bytes(count);
    for (auto& b : bytes) b = static_cast<std::byte>(random());
    return bytes;
}

TEST(Gf256, invertsEachElement) {
    for (unsigned a = 1; a < 256; ++a) {
        const auto element = static_cast<uint8_t>(a);
        EXPECT_EQ(gf256::multiply(element, gf256::inverse(element)), 1) << a;
    }
}

TEST(Gf256, givesEqualResultsForVectorsAndBytes) {
    std::mt19937 random(1);
    for (size_t count : {0, 1, 2, 15, 16, 17, 31, 33, 64, 100, 1430, 8940}) {
        for (unsigned factor = 0; factor<256; factor += count> 100 ? 17 : 1) {
            const Bytes from = randomBytes(random, count);
            Bytes into = randomBytes(random, count);
            Bytes expected = into;
            gf256::multiplyAdd(into, from, static_cast<uint8_t>(factor));
            gf256::multiplyAddScalar(expected, from, static_cast<uint8_t>(factor));
            ASSERT_EQ(into, expected) << count << " bytes by " << factor;
        }
    }
}

TEST(ErasureCode, usesASumAsFirstRow) {
    for (int column = 0; column < kMaxInGroup; ++column) EXPECT_EQ(codeFactor(0, column), 1);
}

// Restores `lost` of k symbols of any lengths from randomly chosen rows.
void loseAndSolve(std::mt19937& random, int k, int lost) {
    std::vector<Bytes> symbols;
    size_t longest = 0;
    for (int i = 0; i < k; ++i) {
        symbols.push_back(randomBytes(random, 1 + random() % 200));
        longest = std::max(longest, symbols.back().size());
    }
    std::vector<int> columns(static_cast<size_t>(k));
    std::vector<int> rows(kMaxRows);
    for (size_t i = 0; i < columns.size(); ++i) columns[i] = static_cast<int>(i);
    for (size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
    std::ranges::shuffle(columns, random);
    std::ranges::shuffle(rows, random);
    const auto missing = std::span(columns).first(static_cast<size_t>(lost));

    std::vector<Bytes> held(static_cast<size_t>(lost), Bytes(longest + kLengthBytes));
    std::vector<HeldRow> heldRows;
    for (size_t r = 0; r < held.size(); ++r) {
        for (int c = 0; c < k; ++c) addSymbol(held[r], rows[r], c, symbols[static_cast<size_t>(c)]);
        for (int c : std::span(columns).subspan(static_cast<size_t>(lost)))
            addSymbol(held[r], rows[r], c, symbols[static_cast<size_t>(c)]);
        heldRows.push_back({rows[r], held[r]});
    }
    Bytes scratch;
    solveMissing(missing, heldRows, scratch);
    for (size_t i = 0; i < missing.size(); ++i) {
        const Bytes& expected = symbols[static_cast<size_t>(missing[i])];
        ASSERT_EQ(loadLittle<uint16_t>(held[i].data()), expected.size());
        ASSERT_TRUE(std::equal(expected.begin(), expected.end(), held[i].begin() + kLengthBytes));
        ASSERT_TRUE(std::all_of(held[i].begin() + static_cast<std::ptrdiff_t>(kLengthBytes + expected.size()),
                                held[i].end(), [](std::byte b) { return b == std::byte{0}; }));
    }
}

TEST(ErasureCode, restoresAnyLossesFromAnyRows) {
    std::mt19937 random(2);
    for (int k = 1; k <= kMaxInGroup; ++k)
        for (int lost = 1; lost <= k; ++lost) loseAndSolve(random, k, lost);
}

} // namespace
} // namespace mural::rsp
