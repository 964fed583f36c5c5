// Depth compositing of an area: selects for each pixel the one that OpenGL's depth test would have left, with its
// colour and whole depth word.
//
// A later pixel replaces an earlier one if `later FUNCTION earlier`, so the draw order decides equal depths. D24S8:
// only the 24 bits of depth are compared; the stencil follows its pixel. D32F: results are independent of the pairing
// of pictures: -0 equals +0; under the four order functions NaN loses to every number, and of two NaNs the earlier
// stays. Equal and NotEqual follow IEEE 754. Reversed Z is Greater or GreaterOrEqual.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compositor/kernels/depth_function.hpp"

namespace mural::compositor {

// One or more rows. Strides are in bytes.
struct ZArea {
    uint32_t* depth = nullptr;
    std::byte* colour = nullptr; // colourBytes each; null: depth only
    const uint32_t* sourceDepth = nullptr;
    const std::byte* sourceColour = nullptr;
    size_t colourBytes = 4; // 4, 8 or 16
    size_t columns = 0;
    size_t rows = 1;
    std::ptrdiff_t depthStride = 0, colourStride = 0, sourceDepthStride = 0, sourceColourStride = 0;

    [[nodiscard]] ZArea row(size_t y) const {
        const auto at = static_cast<std::ptrdiff_t>(y);
        ZArea one = *this;
        one.rows = 1;
        one.depth = reinterpret_cast<uint32_t*>(reinterpret_cast<std::byte*>(depth) + at * depthStride);
        one.sourceDepth =
            reinterpret_cast<const uint32_t*>(reinterpret_cast<const std::byte*>(sourceDepth) + at * sourceDepthStride);
        if (!colour) return one;
        one.colour = colour + at * colourStride;
        one.sourceColour = sourceColour + at * sourceColourStride;
        return one;
    }
    // Returns the area without its first columns.
    [[nodiscard]] ZArea from(size_t column) const {
        ZArea rest = *this;
        rest.depth += column;
        rest.sourceDepth += column;
        rest.columns -= column;
        if (!colour) return rest;
        rest.colour += column * colourBytes;
        rest.sourceColour += column * colourBytes;
        return rest;
    }
};

// Vectorized. Requires natural alignment only.
void zSelect(const ZArea& area, const DepthRule& rule);
// Scalar reference, also used for the last pixels of rows.
void zSelectScalar(const ZArea& area, const DepthRule& rule);

} // namespace mural::compositor
