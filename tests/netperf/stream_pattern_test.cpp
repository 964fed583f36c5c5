// The stream pattern of netperf: receivers detect every kind of error in it.
#include <gtest/gtest.h>

#include "tools/mural/netperf/stream_pattern.hpp"

namespace mural::cli {
namespace {

std::vector<std::byte> pattern(size_t bytes, uint64_t place = 0) {
    std::vector<std::byte> made(bytes);
    fillPattern(made, place);
    return made;
}

std::string faultOf(std::span<const std::byte> bytes, size_t pieceBytes) {
    PatternCheck check;
    for (; bytes.size() > pieceBytes; bytes = bytes.subspan(pieceBytes)) check.take(bytes.first(pieceBytes));
    check.take(bytes);
    return check.fault();
}

TEST(StreamPattern, isIndependentOfPieces) {
    const auto whole = pattern(1000);
    for (const size_t place : {1, 7, 8, 9, 500, 993, 999}) {
        const auto rest = pattern(whole.size() - place, place);
        EXPECT_TRUE(std::ranges::equal(rest, std::span(whole).subspan(place))) << place;
    }
    EXPECT_TRUE(std::ranges::equal(pattern(3, 2), std::span(whole).subspan(2, 3)));
}

TEST(StreamPattern, showsTheReadersFirstPosition) {
    for (const uint64_t place : {0ul, 1ul, 7ul, 8ul, 1430ul * 77, (1ul << 40) + 3}) {
        PatternCheck check;
        const auto bytes = pattern(100, place);
        for (const std::byte& b : bytes) check.take({&b, 1});
        EXPECT_EQ(check.beganAt(), place);
        EXPECT_EQ(check.fault(), "");
    }
    EXPECT_FALSE(findPattern(std::vector<std::byte>(100)));
    EXPECT_FALSE(findPattern(pattern(kFindBytes - 1)));
}

TEST(StreamPattern, detectsLossDuplicatesReorderingAndChanges) {
    const auto right = pattern(20'000);
    for (const size_t pieceBytes : {1, 100, 4096, 20'000}) {
        EXPECT_EQ(faultOf(right, pieceBytes), "");
        auto lost = right;
        lost.erase(lost.begin() + 5000, lost.begin() + 6430);
        EXPECT_NE(faultOf(lost, pieceBytes), "");
        auto twice = right;
        twice.insert(twice.begin() + 6430, right.begin() + 5000, right.begin() + 6430);
        EXPECT_NE(faultOf(twice, pieceBytes), "");
        auto turned = right;
        std::rotate(turned.begin() + 5000, turned.begin() + 6430, turned.begin() + 7860);
        EXPECT_NE(faultOf(turned, pieceBytes), "");
        auto changed = right;
        changed[19'999] ^= std::byte{0x10};
        EXPECT_EQ(faultOf(changed, pieceBytes), "byte 19999 was changed");
        changed[5003] ^= std::byte{0x10};
        EXPECT_EQ(faultOf(changed, pieceBytes), "byte 5003 was changed");
    }
    auto lost = right;
    lost.erase(lost.begin() + 5000, lost.begin() + 6430);
    EXPECT_EQ(faultOf(lost, 20'000), "byte 5000 has the contents of byte 6430");
    EXPECT_EQ(faultOf(std::vector<std::byte>(100), 100), "the first received bytes do not occur in the stream");
}

} // namespace
} // namespace mural::cli
