// Feeds arbitrary batches to the delta decoder. Input: batches with their headers, each after its size (u16). The first
// byte is the kind of input:
//   0  batches as sent
//   1  the sections of one batch, uncompressed, because fuzzers do not pass through compression
//   2  parts of pages that were split, uncompressed
#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "streamcodec/delta/batch_codec.hpp"
#include "streamcodec/delta/entropy/pixel_filter.hpp"
#include "streamcodec/delta/delta_decoder.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/fuzz/delta/fuzz_limits.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace mural::fuzz {
namespace {

std::span<const std::byte> take(std::span<const std::byte>& input, size_t sizeBytes) {
    const auto taken = input.first(std::min(sizeBytes, input.size()));
    input = input.subspan(taken.size());
    return taken;
}

std::span<const std::byte> takeSized(std::span<const std::byte>& input) {
    uint16_t sizeBytes = 0;
    const auto size = take(input, 2);
    std::memcpy(&sizeBytes, size.data(), size.size());
    return take(input, sizeBytes);
}

uint64_t joinPieces(std::span<const std::byte> input) {
    const auto word = [&input] {
        const auto bytes = take(input, 2);
        uint16_t value = 0;
        std::memcpy(&value, bytes.data(), bytes.size());
        return value;
    };
    const size_t pagesBytes = word() * size_t{4}, pieces = word();
    const auto front = takeSized(input);
    delta::PixelFilterDecoder joiner;
    if (!joiner.begin(front, pagesBytes, pieces)) return 0;
    must(joiner.planeBytes() <= pieces * delta::kPageBytes && joiner.restBytes() <= pagesBytes,
         "parts are no larger than the pages");
    // Missing bytes are read as 0.
    std::vector<std::byte> planes(joiner.planeBytes()), rest(joiner.restBytes()), pages(pagesBytes);
    std::ranges::copy(take(input, planes.size()), planes.begin());
    std::ranges::copy(take(input, rest.size()), rest.begin());
    joiner.join(planes, rest, pages);
    return pagesBytes;
}

} // namespace

uint64_t fuzzOne(std::span<const std::byte> input) {
    delta::DeltaDecoder decoder(fuzzLimits());
    delta::BatchDecoder batchDecoder;
    uint64_t packets = 0;
    if (input.empty()) return 0;
    const unsigned kind = static_cast<unsigned>(take(input, 1)[0]) & 3;
    if (kind == 2) return joinPieces(input);
    const bool coded = kind == 0;
    while (!input.empty()) {
        delta::SectionBytes sections;
        if (coded) {
            auto batch = takeSized(input);
            delta::BatchHeadReader head;
            for (bool complete = false; !complete && !batch.empty();) complete = head.add(take(batch, 1)[0]);
            const auto decoded = batchDecoder.decode(head.head(), batch);
            if (!decoded) return packets;
            sections = decoded.value();
        } else {
            for (auto& section : sections) section = takeSized(input);
        }
        decoder.begin(sections);
        while (true) {
            uint32_t stream = 0;
            std::span<const std::byte> packet;
            const auto more = decoder.next(stream, packet);
            if (!more) return packets;
            if (!more.value()) break;
            must(packet.size() <= wire::kMaxPacketBytes, "packets are bounded");
            ++packets;
        }
    }
    return packets;
}

} // namespace mural::fuzz
