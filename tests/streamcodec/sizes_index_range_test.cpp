// The range of vertices of an indexed draw.
#include <gtest/gtest.h>

#include <cstring>

#include "streamcodec/sizes/index_range.hpp"
#include "tests/streamcodec/sizes_random.hpp"

namespace mural::sizes {
namespace {

void expectRange(const IndexRange& range, uint32_t min, uint32_t max) {
    EXPECT_TRUE(range.any);
    EXPECT_EQ(range.min, min);
    EXPECT_EQ(range.max, max);
}

void expectEmpty(const IndexRange& range) {
    EXPECT_FALSE(range.any);
    EXPECT_GT(range.min, range.max);
}

TEST(SizesIndexRange, findsLowestAndHighest) {
    const uint8_t bytes[] = {7, 3, 200, 255};
    expectRange(scanIndices(bytes, GL_UNSIGNED_BYTE, 4, false, 0), 3, 255);
    const uint32_t ints[] = {0x80000000, 5, 0x7fffffff};
    expectRange(scanIndices(ints, GL_UNSIGNED_INT, 3, false, 0), 5, 0x80000000);
}

TEST(SizesIndexRange, skipsRestarts) {
    const uint8_t bytes[] = {255, 3, 255, 9};
    expectRange(scanIndices(bytes, GL_UNSIGNED_BYTE, 4, true, 255), 3, 9);
    const uint16_t zeroRestarts[] = {0, 8, 0, 4};
    expectRange(scanIndices(zeroRestarts, GL_UNSIGNED_SHORT, 4, true, 0), 4, 8);
}

TEST(SizesIndexRange, ignoresARestartIndexBeyondTheType) {
    const uint8_t bytes[] = {255, 3};
    expectRange(scanIndices(bytes, GL_UNSIGNED_BYTE, 2, true, 0xffffffff), 3, 255);
    expectRange(scanIndices(bytes, GL_UNSIGNED_BYTE, 2, true, 0x103), 3, 255);
}

TEST(SizesIndexRange, isEmptyWithoutIndices) {
    expectEmpty(scanIndices(nullptr, GL_UNSIGNED_INT, 0, false, 0));
    const uint16_t restarts[] = {0xffff, 0xffff};
    expectEmpty(scanIndices(restarts, GL_UNSIGNED_SHORT, 2, true, fixedRestartIndex(GL_UNSIGNED_SHORT)));
    expectEmpty(scanIndices(restarts, GL_FLOAT, 2, false, 0));
}

TEST(SizesIndexRange, coversBytesWithARestartInTheMiddle) {
    const uint8_t bytes[] = {0, 255, 100};
    expectRange(scanIndices(bytes, GL_UNSIGNED_BYTE, 3, true, 100), 0, 255);
}

// Every alignment and length around the width of vector registers, compared with a plain loop.
template <class Value> void compareWithPlainLoop(GLenum type, Random& random) {
    for (int round = 0; round < 400; ++round) {
        const auto count = static_cast<size_t>(random.upTo(150));
        const auto misaligned = static_cast<size_t>(random.upTo(7));
        std::vector<uint8_t> memory = random.bytes(count * sizeof(Value) + misaligned);
        const bool restart = random.oneIn(2);
        Value restartIndex = static_cast<Value>(random.byte());
        if (count > 0) std::memcpy(&restartIndex, memory.data() + misaligned, sizeof restartIndex);
        IndexRange expected;
        for (size_t i = 0; i < count; ++i) {
            Value index = 0;
            std::memcpy(&index, memory.data() + misaligned + i * sizeof index, sizeof index);
            if (restart && index == restartIndex) continue;
            expected.any = true;
            expected.min = std::min<uint32_t>(expected.min, index);
            expected.max = std::max<uint32_t>(expected.max, index);
        }
        const IndexRange range = scanIndices(memory.data() + misaligned, type, count, restart, restartIndex);
        ASSERT_EQ(range.any, expected.any);
        ASSERT_EQ(range.min, expected.min);
        ASSERT_EQ(range.max, expected.max);
    }
}

TEST(SizesIndexRange, agreesWithAPlainLoop) {
    const uint32_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    compareWithPlainLoop<uint8_t>(GL_UNSIGNED_BYTE, random);
    compareWithPlainLoop<uint16_t>(GL_UNSIGNED_SHORT, random);
    compareWithPlainLoop<uint32_t>(GL_UNSIGNED_INT, random);
}

} // namespace
} // namespace mural::sizes
