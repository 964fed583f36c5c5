// When bytes are copied, and when a borrowed buffer must stay valid.
#include "streamcodec/delta/section_buffer.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace mural::delta {
namespace {

using Bytes = std::vector<std::byte>;

TEST(SectionBuffer, borrowsASingleLongPiece) {
    const Bytes piece(20'000, std::byte{1});
    SectionBuffer gathered;
    gathered.lend(piece);
    EXPECT_EQ(gathered.bytes().data(), piece.data());
    EXPECT_EQ(gathered.size(), piece.size());
    gathered.clear();
    EXPECT_EQ(gathered.size(), 0u);
    const Bytes little(100, std::byte{2});
    gathered.lend(little);
    EXPECT_NE(gathered.bytes().data(), little.data());
    EXPECT_TRUE(std::ranges::equal(gathered.bytes(), little));
}

TEST(SectionBuffer, keepsBorrowedDataAfterRelease) {
    Bytes piece(20'000, std::byte{1});
    const Bytes before = piece;
    SectionBuffer gathered;
    gathered.lend(piece);
    gathered.own();
    std::ranges::fill(piece, std::byte{9});
    EXPECT_TRUE(std::ranges::equal(gathered.bytes(), before));
}

TEST(SectionBuffer, preservesOrder) {
    const Bytes first(20'000, std::byte{1}), second(30'000, std::byte{2}), third(10, std::byte{3});
    SectionBuffer gathered;
    gathered.lend(first);
    gathered.lend(second);
    gathered.add(third);
    gathered.owned().push_back(std::byte{4});
    Bytes all = first;
    all.insert(all.end(), second.begin(), second.end());
    all.insert(all.end(), third.begin(), third.end());
    all.push_back(std::byte{4});
    EXPECT_TRUE(std::ranges::equal(gathered.bytes(), all));
}

} // namespace
} // namespace mural::delta
