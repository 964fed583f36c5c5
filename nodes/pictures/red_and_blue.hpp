// B G R A as R G B A, and back; alpha is made 255, for it carries nothing in pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mural {

inline void swapRedAndBlue(const std::byte* from, std::byte* to, size_t pixels) {
    for (size_t i = 0; i < pixels; ++i) {
        uint32_t p = 0;
        std::memcpy(&p, from + 4 * i, 4);
        p = 0xff000000 | (p & 0x0000ff00) | (p & 0x00ff0000) >> 16 | (p & 0x000000ff) << 16;
        std::memcpy(to + 4 * i, &p, 4);
    }
}

} // namespace mural
