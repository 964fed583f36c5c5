// Interleaved pixels: of every block of w × h pixels the one at x, y. Source: thesis, "Compounds": pixel.
#pragma once

#include <cstdint>

#include "common/pixel_viewport.hpp"

namespace mural {

struct PixelKernel {
    int32_t x = 0;
    int32_t y = 0;
    int32_t w = 1;
    int32_t h = 1;

    [[nodiscard]] constexpr bool valid() const { return w > 0 && h > 0 && x >= 0 && x < w && y >= 0 && y < h; }
    [[nodiscard]] constexpr bool whole() const { return w == 1 && h == 1; }
    friend constexpr bool operator==(const PixelKernel&, const PixelKernel&) = default;
};

// `inner`'s pixels among those that `outer` left: pixel i of the result is pixel inner.x + inner.w·i of `outer`, so that
// a picture may be put together at each level. (Equalizer multiplies the other way round, and its pictures are right
// only when all is put together at the top.)
[[nodiscard]] constexpr PixelKernel compose(const PixelKernel& outer, const PixelKernel& inner) {
    return {outer.x + outer.w * inner.x, outer.y + outer.h * inner.y, outer.w * inner.w, outer.h * inner.h};
}

// The area that holds a kernel's pixels side by side. Where the kernel does not divide the area, the last column or
// row may stand for pixels outside of it.
[[nodiscard]] constexpr PixelViewport apply(const PixelViewport& area, const PixelKernel& k) {
    return {area.x, area.y, (area.w + k.w - 1) / k.w, (area.h + k.h - 1) / k.h};
}

} // namespace mural
