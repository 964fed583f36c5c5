// Tiles in the wall windows of a node. The windows share them with readers on other threads, so they never change.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/geometry/pixel_viewport.hpp"
#include "nodes/output/picture.hpp"

namespace mural {

struct ShownTiles {
    uint32_t client = 0, window = 0, frame = 0;
    int64_t shownNs = 0;                // monotonic clock
    int width = 0, height = 0;          // of the whole picture
    std::vector<PixelViewport> tiles;   // places in it, from the lower left corner
    std::vector<OwnedPicture> pictures; // of the tiles, in their order; empty tiles have none
};

} // namespace mural
