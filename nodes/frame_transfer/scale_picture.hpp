// Scales pictures that were drawn smaller or larger to their shown size.
#pragma once

#include <cstddef>

#include "common/geometry/pixel_viewport.hpp"
#include "common/geometry/zoom.hpp"

namespace mural {

struct DrawnPicture {
    const std::byte* pixels; // 4 bytes each
    PixelViewport area;      // of the whole picture, in its own pixels
};

// Writes pixels `r` of the shown picture. Interpolates linearly between pixel centres to enlarge, and averages the
// covered area to shrink, per direction. `into` holds the pixels `box`, which contains r. Identical on all machines.
void scalePicture(const DrawnPicture& from, const Zoom& zoom, const PixelViewport& r, std::byte* into,
                  const PixelViewport& box);

} // namespace mural
