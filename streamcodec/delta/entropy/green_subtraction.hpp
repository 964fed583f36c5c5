// Green subtraction: removes the correlation between the colours of a pixel, as QOI and WebP do. Brightness varies more
// than hue, and in grey pictures all colours are equal. Green stays; red and blue become differences to green.
//
// With four bytes per pixel the second byte is green, the fourth stays, and the order is kept. With three bytes per
// pixel all greens come first, then all reds, all blues, and the bytes outside whole pixels.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::delta {

// `filter`: kColoursOfFour or above. Both buffers have kPageBytes and do not overlap.
void subtractGreen(const std::byte* piece, uint8_t filter, std::byte* apart);
void addGreen(const std::byte* apart, uint8_t filter, std::byte* piece);

} // namespace mural::delta
