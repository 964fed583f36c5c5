// Short records skipped together equal those visited one by one.
#include "streamcodec/delta/packet_cut.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/record_rounds.hpp"

namespace mural::delta {
namespace {

TEST(PacketCut, skipsRoundsLikeSingleRecords) {
    uint64_t passed = 0;
    for (uint32_t seed = 0; seed < 3000; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const std::vector<std::byte> packet = mural::testing::recordRounds(
            random, [&](auto& p) { mural::testing::putRecord(p, 7, kMaxTextBytes / 4 + 1 + random() % 3); });
        PacketCut atOnce(packet), byOne(packet);
        while (true) {
            const size_t from = atOnce.at(), sizeBytes = atOnce.passShort();
            Piece piece;
            while (byOne.at() < from + sizeBytes) {
                ASSERT_TRUE(byOne.next(piece));
                ASSERT_FALSE(piece.page());
            }
            ASSERT_EQ(byOne.at(), atOnce.at());
            ASSERT_EQ(byOne.records(), atOnce.records());
            ASSERT_EQ(byOne.lastOpcode(), atOnce.lastOpcode());
            Piece other;
            const bool more = byOne.next(piece);
            ASSERT_EQ(atOnce.next(other), more);
            if (!more) break;
            ASSERT_EQ(piece.at, other.at);
            ASSERT_EQ(piece.sizeBytes, other.sizeBytes);
        }
        passed += atOnce.records();
    }
    EXPECT_GT(passed, 100'000u);
}

} // namespace
} // namespace mural::delta
