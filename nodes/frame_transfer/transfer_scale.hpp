// Transfer of pictures at a reduced size, as the frames of a configuration request (`zoom` of an outputframe). Used by
// the node that sends them and the head that enlarges them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/geometry/zoom.hpp"

namespace mural {

struct ScaledSize {
    int32_t w = 0, h = 0;
    [[nodiscard]] size_t bytes() const { return static_cast<size_t>(w) * static_cast<size_t>(h) * 4; }
};

// The transferred size of a picture of w x h pixels; each factor is at most 1. Both ends compute it.
[[nodiscard]] ScaledSize scaledSizeOf(int32_t w, int32_t h, const Zoom& transferScale);

// Resamples rows of 4-byte pixels: averages to shrink, interpolates linearly between pixel centres to enlarge. Edge
// pixels are extended. `into` has toW x toH pixels. The result is identical on all machines.
void resizePicture(const std::byte* from, int32_t w, int32_t h, std::byte* into, int32_t toW, int32_t toH);

} // namespace mural
