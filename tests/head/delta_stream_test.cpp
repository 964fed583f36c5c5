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

std::unique_ptr<DeltaStream> smallDeltaStream() {
    delta::Limits limits;
    limits.cacheBytes = 16 << 20;
    auto deltaStream = DeltaStream::open(limits);
    return deltaStream ? std::move(*deltaStream) : nullptr;
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
    auto deltaStream = smallDeltaStream();
    ASSERT_NE(deltaStream, nullptr);
    EXPECT_TRUE(deltaStream->empty());
    const auto value = record(wire::kOpBlobData, 12'000);
    deltaStream->add(kStream, value);
    EXPECT_FALSE(deltaStream->empty());
    EXPECT_FALSE(deltaStream->full());
    auto other = value;
    for (size_t i = 4; i < other.size(); ++i) other[i] = ~other[i];
    deltaStream->add(kStream, other);
    EXPECT_TRUE(deltaStream->full()) << "96 kB of new bytes";
    ASSERT_TRUE(deltaStream->take().ok());
    EXPECT_TRUE(deltaStream->empty());
    int packets = 0;
    for (; !deltaStream->full() && packets < 1000; ++packets) deltaStream->add(kStream, value);
    EXPECT_EQ(packets, 88) << "4 MiB that the node has to copy";
    EXPECT_LE(deltaStream->take()->size(), 400u);
    EXPECT_EQ(deltaStream->counts().packer.packets, 90u);
    EXPECT_EQ(deltaStream->counts().packer.rawBytes, 90u * 48'000);
}

TEST(DeltaStream, detectsAnIncompleteBlob) {
    auto deltaStream = smallDeltaStream();
    ASSERT_NE(deltaStream, nullptr);
    deltaStream->add(kStream, record(wire::kOpBlobBegin, 3));
    EXPECT_TRUE(deltaStream->inValue());
    deltaStream->add(kStream, record(wire::kOpBlobData, 300));
    EXPECT_TRUE(deltaStream->inValue());
    deltaStream->add(kStream, record(wire::kFirstGlOpcode, 3));
    EXPECT_FALSE(deltaStream->inValue());
}

// Plain bytes are borrowed while their packet exists. The batch may be taken after the packet is gone.
TEST(DeltaStream, keepsDataAfterThePacketIsGone) {
    auto deltaStream = smallDeltaStream();
    ASSERT_NE(deltaStream, nullptr);
    deltaStream->disableFilter();
    std::vector<std::vector<std::byte>> sent, batches;
    const auto take = [&] {
        auto batch = deltaStream->take();
        ASSERT_TRUE(batch.ok());
        batches.emplace_back(batch->begin(), batch->end());
    };
    deltaStream->sendBy(take);
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
        deltaStream->add(kStream, packet);
        std::ranges::fill(packet, std::byte{0x55});
    }
    if (!deltaStream->empty()) take();
    EXPECT_GE(batches.size(), 2u);
    delta::BatchDecoder decoder;
    delta::DeltaDecoder records(deltaStream->limits());
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
