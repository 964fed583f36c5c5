// Takes masked bits of each pixel from another picture: colour masks of anaglyph stereo, in any format.
#pragma once

#include <array>
#include <cstddef>

namespace mural::compositor {

// Bit mask of a pixel, repeated: 16 bytes are a whole number of pixels in every format.
using ChannelMask = std::array<std::byte, 16>;

// into = (into & ~mask) | (source & mask). The row begins with the mask's first byte.
void maskChannelsRow(std::byte* into, const std::byte* source, size_t sizeBytes, const ChannelMask& mask);
void maskChannelsRowScalar(std::byte* into, const std::byte* source, size_t sizeBytes, const ChannelMask& mask);

} // namespace mural::compositor
