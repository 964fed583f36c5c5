// The range coder restores its input, and expected symbols cost next to nothing.
#include "streamcodec/delta/entropy/range_coder.hpp"

#include "streamcodec/delta/entropy/byte_predictor.hpp"
#include "tests/delta/both_sides.hpp"

namespace mural::delta::testing {
namespace {

struct Models {
    BitModel bit;
    SymbolModel symbol;
    BytePredictor bytes;
    // Encodes random symbols or decodes them; returns their sum.
    template <class Coder> uint64_t all(Coder& coder, std::mt19937& random, int count, uint32_t rare) {
        uint64_t sum = 0;
        for (int i = 0; i < count; ++i) {
            const auto value = static_cast<uint32_t>(random());
            const bool often = value % rare != 0;
            sum = sum * 31 + coder.code(bit, often);
            sum = sum * 31 + coder.code(symbol, often ? 15u : value >> 28);
            sum = sum * 31 + bytes.code(coder, often ? static_cast<uint32_t>(i) & 255 : value >> 24);
            const unsigned bits = 1 + (value >> 8) % 16;
            if (!often) sum = sum * 31 + coder.code(value & ((1u << bits) - 1), bits);
        }
        return sum;
    }
};

TEST(RangeCoder, readsWrittenValues) {
    Models writing, reading; // they live as long as the stream
    RangeWriter writer;
    for (uint32_t batch = 0; batch < 300; ++batch) {
        const int count = static_cast<int>(batch % 5 == 0 ? batch % 3 : batch * 4);
        const uint32_t rare = 1 + batch % 7 * (batch % 2 == 0 ? 100 : 1);
        std::mt19937 there(batch), back(batch);
        const uint64_t sum = writing.all(writer, there, count, rare);
        const auto coded = writer.finish();
        const Bytes bytes(coded.begin(), coded.end());
        writer.clear();
        RangeReader reader(bytes);
        ASSERT_EQ(reading.all(reader, back, count, rare), sum) << batch;
        EXPECT_FALSE(reader.bad());
    }
}

TEST(RangeCoder, needsHundredthsOfABitForExpectedSymbols) {
    Models models;
    RangeWriter writer;
    std::mt19937 random(1);
    (void)models.all(writer, random, 20'000, 1u << 31);
    writer.clear();
    (void)models.all(writer, random, 8'192, 1u << 31);
    EXPECT_LE(writer.finish().size(), 20u);
}

TEST(RangeCoder, reportsReadsPastTheEnd) {
    RangeWriter writer;
    Models writing, reading;
    std::mt19937 there(1), back(1);
    (void)writing.all(writer, there, 50, 2);
    const auto coded = writer.finish();
    const Bytes half(coded.begin(), coded.begin() + static_cast<std::ptrdiff_t>(coded.size() / 2));
    RangeReader reader(half);
    (void)reading.all(reader, back, 1000, 2);
    EXPECT_TRUE(reader.bad());
}

} // namespace
} // namespace mural::delta::testing
