// Swizzles pixels: exchanges red and blue.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/base/picture_format.hpp"

namespace mural {

// Converts B G R A to R G B A, or back, and sets the bits of `alwaysSet` in each word.
inline void swapRedAndBlue(const std::byte* from, std::byte* to, size_t pixels, uint32_t alwaysSet = 0) {
    for (size_t i = 0; i < pixels; ++i) {
        uint32_t p = 0;
        std::memcpy(&p, from + 4 * i, 4);
        p = alwaysSet | (p & 0xff00ff00) | (p & 0x00ff0000) >> 16 | (p & 0x000000ff) << 16;
        std::memcpy(to + 4 * i, &p, 4);
    }
}

// Converts either format. `to` may equal `from`.
inline void swapRedAndBlue(PictureFormat format, const std::byte* from, std::byte* to, size_t pixels) {
    if (format == PictureFormat::Bgra8) return swapRedAndBlue(from, to, pixels);
    for (size_t i = 0; i < pixels; ++i) {
        uint32_t p = 0;
        std::memcpy(&p, from + 4 * i, 4);
        p = (p & 0xc00ffc00) | (p & 0x3ff00000) >> 20 | (p & 0x000003ff) << 20;
        std::memcpy(to + 4 * i, &p, 4);
    }
}

} // namespace mural
