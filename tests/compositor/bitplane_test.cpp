// The bit-plane code of strips: vector and scalar code write equal bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "compositor/codecs/bitplane/bitplane_codec.hpp"
#include "compositor/codecs/bitplane/strip_code.hpp"
#include "compositor/codecs/bitplane/word_arithmetic.hpp"
#include "tests/compositor/random_bytes.hpp"

namespace mural::compositor::bitplane {
namespace {

using test::forEachTarget;

// Rows of words with small, large or no differences, block by block.
std::vector<uint32_t> randomRows(std::mt19937& random, unsigned columns, unsigned rows) {
    std::vector<uint32_t> words(size_t{columns} * rows);
    for (unsigned x = 0; x < columns; ++x) {
        const unsigned kind = (x / kBlockColumns + columns) % 5;
        uint32_t word = random();
        for (unsigned y = 0; y < rows; ++y) {
            if (kind == 1) word += random() % 3 - 1;
            if (kind == 2) word += (random() & 0x0f070301u);
            if (kind == 3) word = random();
            if (kind == 4 && random() % 64 == 0) word ^= 1u << random() % 32;
            words[size_t{y} * columns + x] = word;
        }
    }
    return words;
}

TEST(Bitplane, invertsFoldingAndColours) {
    for (unsigned v = 0; v < 256; ++v) EXPECT_EQ(unfolded(folded(static_cast<uint8_t>(v))), v);
    EXPECT_EQ(folded(uint8_t{255}), 1);
    EXPECT_EQ(folded(uint32_t{0} - 2), 3u);
    std::mt19937 random(1);
    for (const Arithmetic a : {Arithmetic::Bytes, Arithmetic::Halves, Arithmetic::Words, Arithmetic::RotatedWords})
        for (int i = 0; i < 10000; ++i) {
            const auto x = static_cast<uint32_t>(random()), y = static_cast<uint32_t>(random());
            ASSERT_EQ(differenceOf(a, residualOf(a, x)), x);
            ASSERT_EQ(add(a, subtract(a, x, y), y), x);
            ASSERT_EQ(turnedBack(a, turned(a, x)), x);
        }
}

// Every instruction set writes and reads the bytes of the reference.
TEST(Bitplane, givesEqualBytesForVectorsAndWords) {
    forEachTarget([](const char* target) {
        std::mt19937 random(2);
        for (const Arithmetic a : {Arithmetic::Bytes, Arithmetic::Halves, Arithmetic::Words, Arithmetic::RotatedWords})
            for (const Predictor p : {Predictor::Above, Predictor::Slope})
                for (const bool first : {true, false})
                    for (unsigned blocks = 1; blocks <= kMaxBlocks; ++blocks) {
                        const unsigned columns = blocks * kBlockColumns;
                        const std::vector<uint32_t> words = randomRows(random, columns, 6);
                        const auto* rows = reinterpret_cast<const std::byte*>(words.data());
                        const ptrdiff_t stride = 4 * columns;
                        const StripSource source{rows + 2 * stride, stride, rows + stride, rows, blocks};
                        std::vector<std::byte> bytes(kStripBoundBytes + kSlackBytes), expected = bytes;
                        const size_t size = encodeStrip(source, {a, p, first}, bytes.data());
                        ASSERT_EQ(encodeStripScalar(source, {a, p, first}, expected.data()), size);
                        ASSERT_TRUE(
                            std::equal(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size), expected.begin()))
                            << target;

                        ParsedStrip strip;
                        ASSERT_EQ(parseStrip({bytes.data(), size}, blocks, strip), size);
                        std::vector<uint32_t> out = words, scalar = words;
                        std::fill(out.begin() + 2 * columns, out.end(), 0);
                        scalar = out;
                        const auto targetOf = [&](std::vector<uint32_t>& to) {
                            auto* r = reinterpret_cast<std::byte*>(to.data());
                            return StripTarget{r + 2 * stride, stride, r + stride, r, blocks};
                        };
                        decodeStrip(strip, {a, p, first}, targetOf(out));
                        decodeStripScalar(strip, {a, p, first}, targetOf(scalar));
                        ASSERT_EQ(out, words) << target << " arithmetic " << static_cast<int>(a) << " predictor "
                                              << static_cast<int>(p) << " first " << first;
                        ASSERT_EQ(scalar, words);
                    }
    });
}

TEST(Bitplane, rejectsImpossibleStrips) {
    ParsedStrip strip;
    std::vector<std::byte> bytes(4 + 64, std::byte{0});
    bytes[0] = std::byte{1};
    bytes[2] = std::byte{0x08};
    EXPECT_EQ(parseStrip(bytes, 1, strip), bytes.size());
    EXPECT_EQ(parseStrip(std::span(bytes).first(67), 1, strip), 0u) << "cut short";
    bytes.resize(4 + 16 * 8 * 4); // more than any width needs
    for (unsigned width = 9; width < 16; ++width) {
        bytes[2] = static_cast<std::byte>(width);
        EXPECT_EQ(parseStrip(bytes, 1, strip), 0u) << width;
    }
    bytes[2] = std::byte{0};
    bytes[0] = std::byte{2};
    EXPECT_EQ(parseStrip(bytes, 1, strip), 0u) << "there is one block only";
    EXPECT_EQ(parseStrip(std::span(bytes).first(1), 1, strip), 0u);
}

} // namespace
} // namespace mural::compositor::bitplane
