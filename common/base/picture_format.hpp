// Pixel formats of pictures on their way to an output: words of 4 bytes, little-endian, blue in the lowest bits.
#pragma once

#include <cstdint>

namespace mural {

enum class PictureFormat : uint32_t {
    Bgra8 = 0,   // GL_BGRA, GL_UNSIGNED_BYTE
    Bgr10A2 = 1, // GL_BGRA, GL_UNSIGNED_INT_2_10_10_10_REV
};

inline constexpr PictureFormat kLastPictureFormat = PictureFormat::Bgr10A2;

} // namespace mural
