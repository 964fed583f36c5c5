#include "native/session/packet_writer.hpp"

#include <gtest/gtest.h>

#include "common/ipc/capture_ring.hpp"
#include "streamcodec/wire/record_walk.hpp"

namespace mural::native {
namespace {

TEST(PacketWriter, collectsRecordsUpToAChunk) {
    std::vector<size_t> sizes;
    PacketWriter writer([&](std::span<const std::byte> packet) {
        sizes.push_back(packet.size());
        return Result<void>();
    });
    const std::vector<std::byte> record(100'000);
    for (int i = 0; i < 5; ++i) {
        writer.add(record);
        ASSERT_TRUE(writer.sendComplete().ok());
    }
    EXPECT_EQ(sizes, (std::vector<size_t>{200'000, 200'000}));
    ASSERT_TRUE(writer.flush().ok());
    ASSERT_TRUE(writer.flush().ok()); // nothing is left
    EXPECT_EQ(sizes, (std::vector<size_t>{200'000, 200'000, 100'000}));
}

TEST(PacketWriter, writesRecordsThatAWalkReads) {
    std::vector<std::byte> packet;
    PacketWriter writer([&](std::span<const std::byte> sent) {
        packet.assign(sent.begin(), sent.end());
        return Result<void>();
    });
    const uint32_t arguments[2] = {1, 42};
    writer.add(8, std::as_bytes(std::span(arguments)));
    ASSERT_TRUE(writer.flush().ok());
    wire::RecordWalk walk(packet);
    wire::RecordView r;
    ASSERT_TRUE(walk.next(r));
    EXPECT_EQ(r.opcode, 8);
    EXPECT_EQ(wire::argumentWord(r, 1), 42u);
    EXPECT_FALSE(walk.next(r));
    EXPECT_TRUE(walk.whole());
}

TEST(PacketWriter, keepsPacketsThatCannotBeSent) {
    bool fails = true;
    std::vector<size_t> sent;
    PacketWriter writer([&](std::span<const std::byte> packet) -> Result<void> {
        if (fails) return Error{"no room"};
        sent.push_back(packet.size());
        return {};
    });
    writer.add(std::vector<std::byte>(8));
    EXPECT_FALSE(writer.flush().ok());
    EXPECT_EQ(writer.waitingBytes(), 8u);
    writer.add(std::vector<std::byte>(16));
    EXPECT_FALSE(writer.flush().ok());
    fails = false;
    EXPECT_TRUE(writer.flush().ok());
    EXPECT_EQ(sent, (std::vector<size_t>{8, 16}));
    EXPECT_EQ(writer.waitingBytes(), 0u);
}

} // namespace
} // namespace mural::native
