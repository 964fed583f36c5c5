// Pictures that were drawn smaller or larger, made as large as they are shown.
#pragma once

#include <cstddef>

#include "common/pixel_viewport.hpp"
#include "common/zoom.hpp"

namespace mural {

struct DrawnPicture {
    const std::byte* pixels; // 4 bytes each
    PixelViewport area;      // of all of it, by its own pixels
};

// Writes pixels `r` of the picture that is shown: of one that was drawn smaller linearly between the middles of pixels, of one that was drawn
// larger the mean of all that lies in the pixel, each direction by itself. `into` holds pixels `box`, which has all of r. The same on all machines.
void scalePicture(const DrawnPicture& from, const Zoom& zoom, const PixelViewport& r, std::byte* into, const PixelViewport& box);

} // namespace mural
