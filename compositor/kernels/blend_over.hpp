// Ordered blending of a row of premultiplied pixels: front + back * (1 - alpha of front), each component of its own, saturating.
//
// RGBA8 and RGB10A2: the product is divided by 255 (colour of RGB10A2: by 3, what its alpha has) and rounded to the nearest
// number, which is never a tie; sums above the largest value become it (light without cover). RGBA16F and RGBA32F: computed
// in single precision, product before sum, and not clamped; RGBA16F is rounded to the nearest half. NaN stays NaN.
#pragma once

#include <cstddef>

#include "compositor/image/plane_format.hpp"

namespace mural::compositor {

enum class SourceSide : bool { Behind, InFront };

// A colour format. `pixels` and `source` need the alignment of their components.
void blendOverRow(PlaneFormat format, std::byte* pixels, const std::byte* source, size_t count, SourceSide side);
// The same, pixel by pixel.
void blendOverRowScalar(PlaneFormat format, std::byte* pixels, const std::byte* source, size_t count, SourceSide side);

} // namespace mural::compositor
