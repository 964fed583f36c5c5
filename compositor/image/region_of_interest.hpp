// Finds what of a plane is not background, tile by tile, with its holes.
#pragma once

#include <array>

#include "compositor/image/plane.hpp"
#include "compositor/image/region.hpp"

namespace mural::compositor {

// The pixel that a plane was cleared to, as it stands in memory. D24S8: only the depth counts.
struct Background {
    std::array<std::byte, 16> pixel{}; // the first bytesPerPixel of it

    [[nodiscard]] static Background ofWord(uint32_t word); // of planes with 4 bytes per pixel
};

constexpr int32_t kInterestTilePixels = 16;

// The tiles of tilePixels x tilePixels that hold a pixel which is not background, as few rectangles, in pixels of the plane.
[[nodiscard]] Region findRegionOfInterest(const PlaneView& plane, const Background& background, int32_t tilePixels = kInterestTilePixels);
// Of both planes, which have one size: a pixel counts when it is no background in one of them.
[[nodiscard]] Region findRegionOfInterest(const PlaneView& colour, const Background& colourBackground, const PlaneView& depth, const Background& depthBackground,
                                          int32_t tilePixels = kInterestTilePixels);

} // namespace mural::compositor
