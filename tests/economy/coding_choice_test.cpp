#include <gtest/gtest.h>

#include "economy/coding_choice.hpp"

namespace mural::economy {
namespace {

// Both codings tried; then Zstandard takes 3 ns for a byte and halves, LZ4 takes 1 ns and makes 0.7 of it.
CodingChoice measuredChoice(double zstdRatio = 0.5, double lz4Ratio = 0.7) {
    CodingChoice choice;
    for (int i = 0; i < 20; ++i) {
        const size_t size = 10'000;
        choice.measured(Coding::Zstd, size, static_cast<size_t>(size * zstdRatio), 30'000);
        choice.measured(Coding::Lz4, size, static_cast<size_t>(size * lz4Ratio), 10'000);
    }
    return choice;
}

TEST(CodingChoice, slowLinksGetTheSmallestFastOnesNothing) {
    CodingChoice choice = measuredChoice();
    EXPECT_EQ(choice.choose(1000, 80), Coding::Zstd); // 100 Mbit/s
    EXPECT_EQ(choice.choose(1000, 4), Coding::Lz4);
    EXPECT_EQ(choice.choose(1000, 0.8), Coding::Raw); // 10 Gbit/s
}

TEST(CodingChoice, whatDoesNotCompressGoesAsItIs) {
    CodingChoice choice = measuredChoice(1.001, 1.004);
    EXPECT_EQ(choice.choose(1000, 80), Coding::Raw);
}

TEST(CodingChoice, bothAreTriedAndTriedAgain) {
    CodingChoice choice;
    EXPECT_EQ(choice.choose(1000, 8), Coding::Zstd);
    choice.measured(Coding::Zstd, 1 << 16, 1 << 16, 1000);
    EXPECT_EQ(choice.choose(1000, 8), Coding::Lz4);
    choice.measured(Coding::Lz4, 1 << 16, 1 << 16, 1000);
    int compressed = 0;
    for (int i = 0; i < 1000; ++i) compressed += choice.choose(1000, 8) != Coding::Raw;
    EXPECT_GE(compressed, 2);
    EXPECT_LE(compressed, 8);
}

TEST(CodingChoice, shortOnesAreNotCompressed) {
    CodingChoice choice;
    EXPECT_EQ(choice.choose(0, 80), Coding::Empty);
    EXPECT_EQ(choice.choose(CodingChoice::kLeastBytes - 1, 80), Coding::Raw);
}

TEST(LinkRate, onlyWritesThatWaitedCount) {
    LinkRate rate;
    rate.wrote(1 << 20, 100'000); // into the system's buffer
    EXPECT_DOUBLE_EQ(rate.nsPerByte(), 32);
    for (int i = 0; i < 50; ++i) rate.wrote(1 << 20, 80 << 20);
    EXPECT_NEAR(rate.nsPerByte(), 80, 1);
}

} // namespace
} // namespace mural::economy
