// When a batch is sent: soon, but not inside a blob.
#include "nodes/head/broadcast/delta_stream.hpp"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <vector>

#include "streamcodec/delta/delta_decoder.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {
namespace {

constexpr uint32_t kStream = wire::streamOf(1, 0);

std::unique_ptr<DeltaStream> smallEconomy() {
    delta::Limits limits;
    limits.storeBytes = 16 << 20;
    auto economy = DeltaStream::open(limits);
    return economy ? std::move(*economy) : nullptr;
}

// One record with different words.
std::vector<std::byte> record(uint16_t opcode, uint32_t words) {
    std::vector<uint32_t> text(words);
    text[0] = opcode | words << 16;
    for (uint32_t i = 1; i < words; ++i) text[i] = i * 2654435761u;
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

TEST(DeltaStream, isFullByNewDataOrByTotalSize) {
    auto economy = smallEconomy();
    ASSERT_NE(economy, nullptr);
    EXPECT_TRUE(economy->empty());
    const auto value = record(wire::kOpBlobData, 12'000);
    economy->add(kStream, value);
    EXPECT_FALSE(economy->empty());
    EXPECT_FALSE(economy->full());
    auto other = value;
    for (size_t i = 4; i < other.size(); ++i) other[i] = ~other[i];
    economy->add(kStream, other);
    EXPECT_TRUE(economy->full()) << "96 kB of new bytes";
    ASSERT_TRUE(economy->take().ok());
    EXPECT_TRUE(economy->empty());
    int packets = 0;
    for (; !economy->full() && packets < 1000; ++packets) economy->add(kStream, value);
    EXPECT_EQ(packets, 88) << "4 MiB that the node has to copy";
    EXPECT_LE(economy->take()->size(), 400u);
    EXPECT_EQ(economy->counts().packer.packets, 90u);
    EXPECT_EQ(economy->counts().packer.rawBytes, 90u * 48'000);
}

TEST(DeltaStream, detectsAnIncompleteBlob) {
    auto economy = smallEconomy();
    ASSERT_NE(economy, nullptr);
    economy->add(kStream, record(wire::kOpBlobBegin, 3));
    EXPECT_TRUE(economy->inValue());
    economy->add(kStream, record(wire::kOpBlobData, 300));
    EXPECT_TRUE(economy->inValue());
    economy->add(kStream, record(wire::kFirstGlOpcode, 3));
    EXPECT_FALSE(economy->inValue());
}

// Plain bytes are borrowed while their packet exists. The batch may be taken after the packet is gone.
TEST(DeltaStream, keepsDataAfterThePacketIsGone) {
    auto economy = smallEconomy();
    ASSERT_NE(economy, nullptr);
    economy->holdNothing();
    std::vector<std::vector<std::byte>> sent, batches;
    const auto take = [&] {
        auto batch = economy->take();
        ASSERT_TRUE(batch.ok());
        batches.emplace_back(batch->begin(), batch->end());
    };
    economy->sendBy(take);
    uint32_t number = 0;
    // Short packets with new data below and above the size of a batch, and a long one that starts the next batch.
    for (const size_t records : {2000, 10, 500, 30'000, 3000, 500}) {
        std::vector<std::byte> packet;
        for (size_t i = 0; i < records; ++i) {
            auto one = record(wire::kFirstGlOpcode, 4);
            const uint32_t word = ++number * 2654435761u;
            std::memcpy(one.data() + 4, &word, sizeof word);
            packet.insert(packet.end(), one.begin(), one.end());
        }
        sent.push_back(packet);
        economy->add(kStream, packet);
        std::ranges::fill(packet, std::byte{0x55});
    }
    if (!economy->empty()) take();
    EXPECT_GE(batches.size(), 2u);
    delta::BatchDecoder decoder;
    delta::DeltaDecoder records(economy->limits());
    size_t got = 0;
    for (const auto& batch : batches) {
        delta::BatchHeadReader head;
        size_t at = 0;
        while (at < batch.size() && !head.add(batch[at++])) {}
        auto sections = decoder.decode(head.head(), std::span(batch).subspan(at));
        ASSERT_TRUE(sections.ok());
        records.begin(*sections);
        uint32_t stream = 0;
        std::span<const std::byte> bytes;
        while (true) {
            auto more = records.next(stream, bytes);
            ASSERT_TRUE(more.ok());
            if (!*more) break;
            ASSERT_LT(got, sent.size());
            EXPECT_TRUE(std::ranges::equal(bytes, sent[got])) << got;
            ++got;
        }
    }
    EXPECT_EQ(got, sent.size());
}

} // namespace
} // namespace mural
