// An encoder connected to a decoder, and packets for them.
#pragma once

#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <span>
#include <vector>

#include "streamcodec/delta/batch_codec.hpp"
#include "streamcodec/delta/delta_encoder.hpp"
#include "streamcodec/delta/delta_decoder.hpp"

namespace mural::delta::testing {

using Bytes = std::vector<std::byte>;

struct Packet {
    uint32_t stream = 0x10000;
    Bytes bytes;
    bool operator==(const Packet&) const = default;
};

inline Limits tinyLimits() {
    return {.cacheBytes = 8 * kPageBytes, .textBytes = 4096, .logItems = 64, .streams = 2, .modelWords = 1024};
}

class BothSides {
public:
    explicit BothSides(const Limits& limits)
        : encoder(limits), decoder(limits), batchEncoder_([](size_t) { return int64_t{0}; }) {}

    // Sends one batch as a frame and returns its encoded size.
    size_t send(const std::vector<Packet>& packets) {
        for (const Packet& p : packets) encoder.add(p.stream, p.bytes, walked);
        staged = encoder.stagedBytes();
        auto batch = batchEncoder_.encode(encoder.finish(), 8, encoder.plain());
        if (!batch) {
            ADD_FAILURE() << batch.error().message;
            return 0;
        }
        const Bytes wire(batch->begin(), batch->end());
        encoder.clear();
        encoder.beginFrame(encoder.plain(), goesOn);
        BatchHeadReader head;
        size_t at = 0;
        while (at < wire.size() && !head.add(wire[at++])) {}
        EXPECT_EQ(head.head().sizeBytes, wire.size() - at);
        auto sections = batchDecoder_.decode(head.head(), std::span(wire).subspan(at));
        if (!sections) {
            ADD_FAILURE() << sections.error().message;
            return 0;
        }
        decoder.begin(*sections);
        for (const Packet& sent : packets) {
            Packet got;
            std::span<const std::byte> bytes;
            auto more = decoder.next(got.stream, bytes);
            if (!more || !*more) {
                ADD_FAILURE() << (more ? "a packet is missing" : more.error().message);
                return 0;
            }
            got.bytes.assign(bytes.begin(), bytes.end());
            EXPECT_TRUE(got == sent);
        }
        Packet none;
        std::span<const std::byte> bytes;
        auto more = decoder.next(none.stream, bytes);
        EXPECT_TRUE(more && !*more) << "more than was sent";
        return wire.size();
    }
    const RecordOffsets* walked = nullptr; // passed to the encoder
    bool goesOn = false;                   // continues the previous frame
    size_t send(Bytes packet) { return send({Packet{0x10000, std::move(packet)}}); }

    DeltaEncoder encoder;
    DeltaDecoder decoder;
    uint64_t staged = 0; // of the last batch

private:
    BatchEncoder batchEncoder_;
    BatchDecoder batchDecoder_;
};

// A record of `words` words including the header; `fill` generates the others.
inline void addRecord(Bytes& to, uint16_t opcode, uint32_t words, const std::function<uint32_t()>& fill) {
    const auto add = [&](uint32_t word) {
        const auto* p = reinterpret_cast<const std::byte*>(&word);
        to.insert(to.end(), p, p + 4);
    };
    const bool isLong = words >= 0xffff;
    add(opcode | (isLong ? 0xffffu : words) << 16);
    if (isLong) add(words);
    for (uint32_t i = isLong ? 2 : 1; i < words; ++i) add(fill());
}

} // namespace mural::delta::testing
