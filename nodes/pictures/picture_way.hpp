// Pictures that travel smaller than they were drawn, as frames of a configuration want it (`zoom` of an outputframe), and are shown as
// large as it says: what a node sends, and what the head makes of it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/zoom.hpp"

namespace mural {

struct SizeOnWay {
    int32_t w = 0, h = 0;
    [[nodiscard]] size_t bytes() const { return static_cast<size_t>(w) * static_cast<size_t>(h) * 4; }
};

// Of a picture of w x h pixels, each direction at most 1. Both ends reckon it.
[[nodiscard]] SizeOnWay sizeOnWay(int32_t w, int32_t h, const Zoom& way);

// Rows of 4 bytes per pixel from one size to another: smaller by means, larger linearly between the middles of pixels; each picture by itself, its
// outermost pixels count on. `into` has toW x toH pixels. The same on all machines.
void resizePicture(const std::byte* from, int32_t w, int32_t h, std::byte* into, int32_t toW, int32_t toH);

} // namespace mural
