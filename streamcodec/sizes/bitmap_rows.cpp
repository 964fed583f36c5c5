#include "streamcodec/sizes/bitmap_rows.hpp"

namespace mural::sizes {
namespace {

uint8_t reversed(uint8_t bits) {
    uint32_t b = bits;
    b = (b & 0xf0) >> 4 | (b & 0x0f) << 4;
    b = (b & 0xcc) >> 2 | (b & 0x33) << 2;
    b = (b & 0xaa) >> 1 | (b & 0x55) << 1;
    return static_cast<uint8_t>(b);
}

uint8_t clientByte(const uint8_t* client, size_t at, bool lsbFirst) {
    return lsbFirst ? reversed(client[at]) : client[at];
}

size_t bytesOfBits(size_t bits) { return (bits + 7) / 8; }

// Mask of the highest `bits` bits of a byte.
uint8_t highBits(size_t bits) { return static_cast<uint8_t>(bits >= 8 ? 0xff : 0xff00u >> bits); }

} // namespace

void packBitmapRow(uint8_t* tight, const uint8_t* client, const BitmapRow& row) {
    const size_t tightSize = bytesOfBits(row.width);
    const size_t clientSize = bytesOfBits(size_t{row.firstBit} + row.width);
    for (size_t i = 0; i < tightSize; ++i) {
        uint32_t bits = static_cast<uint32_t>(clientByte(client, i, row.lsbFirst)) << 8;
        if (i + 1 < clientSize) bits |= clientByte(client, i + 1, row.lsbFirst);
        tight[i] = static_cast<uint8_t>(bits << row.firstBit >> 8);
    }
    uint8_t& last = tight[tightSize - 1];
    last = static_cast<uint8_t>(last & highBits(row.width - (tightSize - 1) * 8));
}

void unpackBitmapRow(uint8_t* client, const uint8_t* tight, const BitmapRow& row) {
    const size_t tightSize = bytesOfBits(row.width);
    const size_t endBit = size_t{row.firstBit} + row.width;
    const size_t clientSize = bytesOfBits(endBit);
    for (size_t i = 0; i < clientSize; ++i) {
        uint32_t bits = i > 0 ? static_cast<uint32_t>(tight[i - 1]) << 8 : 0;
        if (i < tightSize) bits |= tight[i];
        uint8_t value = static_cast<uint8_t>(bits >> row.firstBit);
        uint8_t mask = highBits(endBit - i * 8);
        if (i == 0) mask = static_cast<uint8_t>(mask & 0xff >> row.firstBit);
        if (row.lsbFirst) {
            value = reversed(value);
            mask = reversed(mask);
        }
        client[i] = static_cast<uint8_t>((client[i] & ~mask) | (value & mask));
    }
}

} // namespace mural::sizes
