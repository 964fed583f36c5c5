// Index and number of the drawn sample of each pixel. The average of all samples is an antialiased picture. Source:
// thesis, "Compounds": subpixel.
#pragma once

#include <cstdint>

namespace mural {

struct SubPixel {
    int32_t index = 0;
    int32_t size = 1;

    [[nodiscard]] constexpr bool valid() const { return size > 0 && index >= 0 && index < size; }
    [[nodiscard]] constexpr bool whole() const { return size == 1; }
    friend constexpr bool operator==(const SubPixel&, const SubPixel&) = default;
};

[[nodiscard]] constexpr SubPixel compose(const SubPixel& outer, const SubPixel& inner) {
    return {outer.index * inner.size + inner.index, outer.size * inner.size};
}

} // namespace mural
