// Rows of single bits: between any bit offset and bit order in client memory, and the tight form
// (first pixel in the most significant bit of the first byte, zero bits behind the last).
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::sizes {

struct BitmapRow {
    uint32_t firstBit; // of the client row, 0…7
    uint32_t width;    // pixels, at least 1
    bool lsbFirst;     // order of the client's bits
};

void packBitmapRow(uint8_t* tight, const uint8_t* client, const BitmapRow& row);
// Leaves the bits before the first and behind the last pixel as they are.
void unpackBitmapRow(uint8_t* client, const uint8_t* tight, const BitmapRow& row);

} // namespace mural::sizes
