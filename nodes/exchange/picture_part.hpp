// A picture with its depths that one node has drawn a range of, to be put together with the others'.
#pragma once

#include <cstdint>
#include <vector>

#include "common/pixel_viewport.hpp"

namespace mural {

// Which picture; the same at all nodes that take part.
struct PictureId {
    uint32_t client = 0;
    uint64_t serial = 0; // of the window's compositions, counted by all nodes alike
    PixelViewport box;   // in the window

    friend bool operator==(const PictureId&, const PictureId&) = default;
};

struct PicturePart {
    PictureId id;
    std::vector<uint32_t> colour; // [y][x], 8 bits each of R G B A in memory; rows bottom first
    std::vector<uint32_t> depth;  // [y][x], 0 to 2^32 - 1

    [[nodiscard]] size_t at(int32_t x, int32_t y) const { return static_cast<size_t>(y) * static_cast<size_t>(id.box.w) + static_cast<size_t>(x); }
};

} // namespace mural
