// Conversion of bitmap rows between client memory, with any bit offset and bit order, and the tight form: the first
// pixel in the most significant bit of the first byte, zero padding at the end.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::sizes {

struct BitmapRow {
    uint32_t firstBit; // of the client row, 0…7
    uint32_t width;    // pixels, at least 1
    bool lsbFirst;     // bit order of the client
};

void packBitmapRow(uint8_t* tight, const uint8_t* client, const BitmapRow& row);
// Preserves the bits before the first and after the last pixel.
void unpackBitmapRow(uint8_t* client, const uint8_t* tight, const BitmapRow& row);

} // namespace mural::sizes
