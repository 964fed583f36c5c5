// The erasure code.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "common/base/little_endian.hpp"
#include "transport/rsp/erasure/erasure_code.hpp"

namespace mural::rsp {
namespace {

using Bytes = std::vector<std::byte>;

Bytes randomBytes(std::mt19937& random, size_t count) {
    Bytes bytes(count);
    for (auto& b : bytes) b = static_cast<std::byte>(random());
    return bytes;
}

// Multiplies in GF(2^8) bit by bit.
uint8_t product(unsigned a, unsigned b) {
    unsigned result = 0;
    for (; b != 0; b >>= 1, a = a << 1 ^ (a & 0x80 ? 0x11du : 0)) {
        if (b & 1) result ^= a;
    }
    return static_cast<uint8_t>(result);
}

// Datagrams of other builds carry these coefficients: row r, column c holds (c ^ 32) / ((r + 32) ^ c).
TEST(ErasureCode, usesTheCoefficientsOfTheProtocol) {
    for (int row = 0; row < kMaxRows; ++row)
        for (int column = 0; column < kMaxInGroup; ++column)
            ASSERT_EQ(product(codeFactor(row, column), static_cast<unsigned>((row + kMaxInGroup) ^ column)),
                      kMaxInGroup ^ column);
}

TEST(ErasureCode, addsSymbolsOfAnyLengthByteByByte) {
    std::mt19937 random(1);
    for (size_t count : {0, 1, 2, 15, 16, 17, 31, 33, 63, 64, 65, 100, 1430, 8940}) {
        for (int row = 0; row < kMaxRows; row += 7) {
            const int column = static_cast<int>(random() % kMaxInGroup);
            const Bytes payload = randomBytes(random, count);
            Bytes symbol = randomBytes(random, count + kLengthBytes + 3);
            Bytes expected = symbol;
            addSymbol(symbol, row, column, payload);
            std::array<std::byte, kLengthBytes> length;
            storeLittle(length.data(), static_cast<uint16_t>(count));
            for (size_t i = 0; i < kLengthBytes + count; ++i) {
                const std::byte from = i < kLengthBytes ? length[i] : payload[i - kLengthBytes];
                expected[i] ^=
                    static_cast<std::byte>(product(codeFactor(row, column), std::to_integer<unsigned>(from)));
            }
            ASSERT_EQ(symbol, expected) << count << " bytes, row " << row << ", column " << column;
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
