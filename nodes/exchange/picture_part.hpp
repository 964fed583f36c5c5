// One node's range of a picture, with depth, as input of sort-last compositing.
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/pixel_viewport.hpp"

namespace mural {

// Identifies a picture on all participating nodes.
struct PictureId {
    uint32_t client = 0;
    uint64_t serial = 0; // number of the window's composition, equal on all nodes
    PixelViewport box;   // in the window

    friend bool operator==(const PictureId&, const PictureId&) = default;
};

struct PicturePart {
    PictureId id;
    // [y][x], rows bottom first: bytes R G B A, or half floats R G B A in two words (CompositeRule::hasHalfFloats)
    std::vector<uint32_t> colour;
    std::vector<uint32_t> depth; // [y][x], 0 to 2^32 - 1; may be empty if the parts are blended
    uint32_t order = 0;          // hash of the order in which ranges are blended; 0: of their numbers

    [[nodiscard]] size_t at(int32_t x, int32_t y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(id.box.w) + static_cast<size_t>(x);
    }
};

} // namespace mural
