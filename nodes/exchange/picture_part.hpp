// A picture with its depths that one node has drawn for another to put together.
#pragma once

#include <cstdint>
#include <vector>

#include "common/pixel_viewport.hpp"

namespace mural {

struct PicturePart {
    uint32_t client = 0, window = 0;
    uint64_t serial = 0;            // of the exchange, counted by both ends alike
    PixelViewport box;              // in the window
    std::vector<uint32_t> colour;   // [y][x], 8 bits each of R G B A in memory; rows bottom first
    std::vector<uint32_t> depth;    // [y][x], 0 to 2^32 - 1
};

// Which of two depths hides the other.
enum class DepthOrder : uint32_t { Less, LessOrEqual, Greater, GreaterOrEqual };

// Lays `later`, drawn after all that is in `into`, over it as one machine's depth test would have: pixel by pixel, the
// later wins when the test passes. What `later` has not drawn has the values that both were cleared to.
// Both have one box. Source: accuracy 4 (fold in draw order).
void mergeByDepth(PicturePart& into, const PicturePart& later, DepthOrder order, uint32_t clearedColour, uint32_t clearedDepth);

} // namespace mural
