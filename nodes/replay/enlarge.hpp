// Pictures that were drawn smaller, made as large as they are shown.
#pragma once

#include <cstddef>

#include "common/pixel_viewport.hpp"
#include "common/zoom.hpp"

namespace mural {

struct SmallPicture {
    const std::byte* pixels; // 4 bytes each
    PixelViewport area;      // of the whole small picture
};

// Writes pixels `r` of the large picture, linearly between the middles of the small one's. `into` holds those of `box`, which has all of r.
void enlarge(const SmallPicture& from, const Zoom& zoom, const PixelViewport& r, std::byte* into, const PixelViewport& box);

} // namespace mural
