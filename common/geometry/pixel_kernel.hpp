// Interleaved pixels: pixel x, y of every block of w x h pixels. Source: thesis, "Compounds": pixel.
#pragma once

#include <cstdint>

#include "common/geometry/pixel_viewport.hpp"

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

// Returns the kernel of `inner` applied to the pixels of `outer`. Pixel i of the result is pixel inner.x + inner.w * i
// of `outer`, so pictures can be assembled at each level. (Equalizer multiplies in the other order; its pictures are
// right only when assembled at the root.)
[[nodiscard]] constexpr PixelKernel compose(const PixelKernel& outer, const PixelKernel& inner) {
    return {outer.x + outer.w * inner.x, outer.y + outer.h * inner.y, outer.w * inner.w, outer.h * inner.h};
}

// Returns the area that holds the kernel's pixels side by side. If the kernel does not divide the area, the last column
// or row may represent pixels outside.
[[nodiscard]] constexpr PixelViewport apply(const PixelViewport& area, const PixelKernel& k) {
    return {area.x, area.y, (area.w + k.w - 1) / k.w, (area.h + k.h - 1) / k.h};
}

} // namespace mural
