// The bit-plane code of a strip, word by word: the reference for the vector code of strip_code.cpp.
#include <bit>
#include <cstring>

#include "common/base/little_endian.hpp"
#include "compositor/codecs/bitplane/strip_code.hpp"
#include "compositor/codecs/bitplane/word_arithmetic.hpp"

namespace mural::compositor::bitplane {

namespace {

uint32_t wordAt(const std::byte* row, unsigned column) {
    uint32_t word;
    std::memcpy(&word, row + 4 * column, sizeof word);
    return word;
}

// Packing of a channel of 64 bytes with at most `width` bits: bits 0 to 3 if the width contains 4, the next two if it
// contains 2, the next one if it contains 1. A group of n bits stores byte i of 8 / n equal parts in one byte.
void packChannel(const uint8_t* bytes, unsigned width, std::byte* into) {
    if (width == 8) {
        std::memcpy(into, bytes, kChannelBytes);
        return;
    }
    unsigned shift = 0;
    for (const unsigned bits : {4u, 2u, 1u}) {
        if ((width & bits) == 0) continue;
        const unsigned partBytes = kChannelBytes * bits / 8;
        for (unsigned i = 0; i < partBytes; ++i) {
            unsigned packed = 0;
            for (unsigned part = 0; part < 8 / bits; ++part)
                packed |= (bytes[i + part * partBytes] >> shift & ((1u << bits) - 1)) << (part * bits);
            into[i] = static_cast<std::byte>(packed);
        }
        into += partBytes;
        shift += bits;
    }
}

void unpackChannel(const std::byte* from, unsigned width, uint8_t* bytes) {
    if (width == 8) {
        std::memcpy(bytes, from, kChannelBytes);
        return;
    }
    std::memset(bytes, 0, kChannelBytes);
    unsigned shift = 0;
    for (const unsigned bits : {4u, 2u, 1u}) {
        if ((width & bits) == 0) continue;
        const unsigned partBytes = kChannelBytes * bits / 8;
        for (unsigned i = 0; i < kChannelBytes; ++i) {
            const unsigned packed = std::to_integer<unsigned>(from[i % partBytes]);
            bytes[i] =
                static_cast<uint8_t>(bytes[i] | (packed >> (i / partBytes * bits) & ((1u << bits) - 1)) << shift);
        }
        from += partBytes;
        shift += bits;
    }
}

} // namespace

size_t parseStrip(std::span<const std::byte> bytes, unsigned blocks, ParsedStrip& into) {
    if (bytes.size() < kStripHeadBytes) return 0;
    into.present = loadLittle<uint16_t>(bytes.data());
    if (into.present >> blocks != 0) return 0;
    const auto count = static_cast<size_t>(std::popcount(into.present));
    size_t size = kStripHeadBytes + 2 * count;
    if (bytes.size() < size) return 0;
    into.payload = bytes.data() + size;
    for (size_t i = 0; i < count; i += 4) {
        const uint64_t mask = count - i < 4 ? (uint64_t{1} << 16 * (count - i)) - 1 : ~uint64_t{0};
        const uint64_t four = loadLittle<uint64_t>(bytes.data() + kStripHeadBytes + 2 * i) & mask;
        if (!validWidths(four)) return 0;
        size += payloadBytes(four);
        for (size_t j = 0; j < 4; ++j) into.widths[i + j] = static_cast<uint16_t>(four >> 16 * j);
    }
    return size <= bytes.size() ? size : 0;
}

size_t encodeStripScalar(const StripSource& source, const StripKind& kind, std::byte* into) {
    const Arithmetic a = kind.arithmetic;
    uint32_t present = 0;
    std::array<uint16_t, kMaxBlocks> widths{};
    std::array<std::array<uint8_t, kBlockBytes>, kMaxBlocks> blocks{};
    size_t count = 0;
    for (unsigned b = 0; b < source.blocks; ++b) {
        auto& channels = blocks[count];
        std::array<uint8_t, 4> ored{};
        for (unsigned x = 0; x < kBlockColumns; ++x) {
            const unsigned column = b * kBlockColumns + x;
            uint32_t above = turned(a, wordAt(source.above, column));
            uint32_t slope = kind.predictor == Predictor::Slope && !kind.first
                                 ? subtract(a, above, turned(a, wordAt(source.above2, column)))
                                 : 0;
            for (unsigned y = 0; y < kStripRows; ++y) {
                const uint32_t word = turned(a, wordAt(source.rows + y * source.strideBytes, column));
                const uint32_t difference = subtract(a, word, above);
                const uint32_t residual = residualOf(a, subtract(a, difference, slope));
                if (kind.predictor == Predictor::Slope && !(kind.first && y == 0)) slope = difference;
                above = word;
                for (unsigned c = 0; c < 4; ++c) {
                    channels[c * kChannelBytes + 4 * x + y] = static_cast<uint8_t>(residual >> (8 * c));
                    ored[c] = static_cast<uint8_t>(ored[c] | residual >> (8 * c));
                }
            }
        }
        unsigned width = 0;
        for (unsigned c = 0; c < 4; ++c) width |= static_cast<unsigned>(std::bit_width(ored[c])) << (4 * c);
        if (width == 0) continue;
        present |= 1u << b;
        widths[count++] = static_cast<uint16_t>(width);
    }
    storeLittle(into, static_cast<uint16_t>(present));
    size_t size = kStripHeadBytes;
    for (size_t i = 0; i < count; ++i, size += 2) storeLittle(into + size, widths[i]);
    for (size_t i = 0; i < count; ++i)
        for (unsigned c = 0; c < 4; ++c) {
            const unsigned width = widths[i] >> (4 * c) & 15;
            packChannel(blocks[i].data() + c * kChannelBytes, width, into + size);
            size += 8 * static_cast<size_t>(width);
        }
    return size;
}

void decodeStripScalar(const ParsedStrip& strip, const StripKind& kind, const StripTarget& target) {
    const Arithmetic a = kind.arithmetic;
    const std::byte* payload = strip.payload;
    size_t index = 0;
    for (unsigned b = 0; b < target.blocks; ++b) {
        std::array<uint8_t, kBlockBytes> channels{};
        if (strip.present >> b & 1) {
            const uint16_t widths = strip.widths[index++];
            for (unsigned c = 0; c < 4; ++c) {
                unpackChannel(payload, widths >> (4 * c) & 15, channels.data() + c * kChannelBytes);
                payload += 8 * (widths >> (4 * c) & 15);
            }
        }
        for (unsigned x = 0; x < kBlockColumns; ++x) {
            const unsigned column = b * kBlockColumns + x;
            uint32_t above = turned(a, wordAt(target.above, column));
            uint32_t slope = kind.predictor == Predictor::Slope && !kind.first
                                 ? subtract(a, above, turned(a, wordAt(target.above2, column)))
                                 : 0;
            for (unsigned y = 0; y < kStripRows; ++y) {
                uint32_t residual = 0;
                for (unsigned c = 0; c < 4; ++c)
                    residual |= uint32_t{channels[c * kChannelBytes + 4 * x + y]} << (8 * c);
                const uint32_t difference = add(a, differenceOf(a, residual), slope);
                if (kind.predictor == Predictor::Slope && !(kind.first && y == 0)) slope = difference;
                above = add(a, above, difference);
                const uint32_t word = turnedBack(a, above);
                std::memcpy(target.rows + y * target.strideBytes + 4 * column, &word, sizeof word);
            }
        }
    }
}

} // namespace mural::compositor::bitplane
