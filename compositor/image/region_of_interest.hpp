// Finds the tiles of a plane that contain more than background, including holes.
#pragma once

#include <array>

#include "compositor/image/plane.hpp"
#include "compositor/image/region.hpp"

namespace mural::compositor {

// The clear value of a plane as it is in memory. D24S8: only the depth counts.
struct Background {
    std::array<std::byte, 16> pixel{}; // the first bytesPerPixel bytes count

    [[nodiscard]] static Background ofWord(uint32_t word); // for planes with 4 bytes per pixel
};

constexpr int32_t kInterestTilePixels = 16;

// Returns the tiles of tilePixels x tilePixels with a non-background pixel, as few rectangles, in pixels of the plane.
[[nodiscard]] Region findRegionOfInterest(const PlaneView& plane, const Background& background,
                                          int32_t tilePixels = kInterestTilePixels);
// The same for two planes of equal size: a pixel counts if it is not background in one of them.
[[nodiscard]] Region findRegionOfInterest(const PlaneView& colour, const Background& colourBackground,
                                          const PlaneView& depth, const Background& depthBackground,
                                          int32_t tilePixels = kInterestTilePixels);

} // namespace mural::compositor
