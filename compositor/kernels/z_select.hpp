// Depth composition of an area: for each pixel the one that OpenGL's depth test would have left, colour and depth word whole.
//
// A later pixel replaces an earlier one if `later FUNCTION earlier` holds; so the draw order decides ties. D24S8: only the 24
// bits of depth are compared, the stencil comes along with its pixel. D32F, so that no result depends on how pictures are
// paired: -0 equals +0; under the four order functions NaN loses against every number, and of two NaNs the earlier one
// stays. Equal and NotEqual compare as IEEE 754 says. Reversed Z is Greater or GreaterOrEqual.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compositor/kernels/depth_function.hpp"

namespace mural::compositor {

// One row, or several. All strides count bytes from row to row.
struct ZArea {
    uint32_t* depth = nullptr;
    std::byte* colour = nullptr; // of colourBytes each; null: depth only
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
        one.sourceDepth = reinterpret_cast<const uint32_t*>(reinterpret_cast<const std::byte*>(sourceDepth) + at * sourceDepthStride);
        if (!colour) return one;
        one.colour = colour + at * colourStride;
        one.sourceColour = sourceColour + at * sourceColourStride;
        return one;
    }
    // Without its first columns.
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

// With the widest vectors of this machine. Addresses need the alignment of their types only.
void zSelect(const ZArea& area, const DepthRule& rule);
// The same, pixel by pixel, as the rules above read: what zSelect is tested against, and the last pixels of its rows.
void zSelectScalar(const ZArea& area, const DepthRule& rule);

} // namespace mural::compositor
