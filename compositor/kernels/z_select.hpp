// Depth composition of a row: for each pixel the one that OpenGL's depth test would have left, colour and depth word whole.
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

struct ZRow {
    uint32_t* depth = nullptr;
    std::byte* colour = nullptr; // of colourBytes each; null: depth only
    const uint32_t* sourceDepth = nullptr;
    const std::byte* sourceColour = nullptr;
    size_t colourBytes = 4; // 4, 8 or 16
    size_t count = 0;
};

// With the widest vectors of this machine. Addresses need the alignment of their types only.
void zSelectRow(const ZRow& row, const DepthRule& rule);
// The same, pixel by pixel, as the rules above read: what zSelectRow is tested against, and its last pixels.
void zSelectRowScalar(const ZRow& row, const DepthRule& rule);

} // namespace mural::compositor
