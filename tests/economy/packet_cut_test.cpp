// Short records that are passed at once are those that come one by one.
#include "economy/packet_cut.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace mural::economy {
namespace {

// Rounds of a few records, some with a long one behind them.
std::vector<std::byte> someRecords(std::mt19937& random) {
    std::vector<std::byte> packet;
    const auto below = [&](uint32_t n) { return random() % n; };
    const auto put = [&](uint32_t opcode, uint32_t words) {
        const uint32_t head = words << 16 | opcode;
        const size_t at = packet.size();
        packet.resize(at + size_t{words} * 4, std::byte{0x5a});
        std::memcpy(packet.data() + at, &head, sizeof head);
    };
    for (uint32_t part = below(10); part > 0; --part) {
        const size_t from = packet.size();
        for (uint32_t n = 1 + below(20); n > 0; --n) put(1 + below(5), 1 + below(6));
        const std::vector<std::byte> round(packet.begin() + static_cast<std::ptrdiff_t>(from), packet.end());
        for (uint32_t n = below(9); n > 0; --n) packet.insert(packet.end(), round.begin(), round.end());
        if (below(5) == 0) put(7, kMostTextBytes / 4 + 1 + below(3));
    }
    return packet;
}

TEST(PacketCut, passesRoundsAsIfOneByOne) {
    uint64_t passed = 0;
    for (uint32_t seed = 0; seed < 3000; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const std::vector<std::byte> packet = someRecords(random);
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
} // namespace mural::economy
