// A picture with its depths that one node has drawn for another to put together.
#pragma once

#include <cstdint>
#include <vector>

#include "common/pixel_viewport.hpp"
#include "compositor/kernels/depth_function.hpp"

namespace mural {

struct PicturePart {
    uint32_t client = 0, window = 0;
    uint64_t serial = 0;            // of the exchange, counted by both ends alike
    PixelViewport box;              // in the window
    std::vector<uint32_t> colour;   // [y][x], 8 bits each of R G B A in memory; rows bottom first
    std::vector<uint32_t> depth;    // [y][x], 0 to 2^32 - 1
};

// Lays `later`, drawn after all that is in `into`, over it as one machine's depth test would have: pixel by pixel, the
// later wins when the test passes. What `later` has not drawn has the values that both were cleared to.
// Both have one box. function: Less, LessOrEqual, Greater or GreaterOrEqual; with others nothing is laid over. Windows may
// have 32 whole bits of depth, which is neither of compositor/image's formats. Source: accuracy 4 (fold in draw order).
void mergeByDepth(PicturePart& into, const PicturePart& later, compositor::DepthFunction function, uint32_t clearedColour, uint32_t clearedDepth);

} // namespace mural
