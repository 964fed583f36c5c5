// Ordered blending of a row of premultiplied pixels: front + back * (1 - alpha of front), per component, saturating.
//
// RGBA8 and RGB10A2: the product is divided by 255 (colour of RGB10A2: by 3, the maximum of its alpha) and rounded to
// nearest, without ties; sums saturate (light without coverage). RGBA16F and RGBA32F: single precision, separate
// product and sum, not clamped; RGBA16F rounds to the nearest half. NaN stays NaN.
#pragma once

#include <cstddef>

#include "compositor/image/plane_format.hpp"

namespace mural::compositor {

enum class SourceSide : bool { Behind, InFront };

// Requires a colour format, and pixels aligned to their components.
void blendOverRow(PlaneFormat format, std::byte* pixels, const std::byte* source, size_t count, SourceSide side);
// Scalar reference.
void blendOverRowScalar(PlaneFormat format, std::byte* pixels, const std::byte* source, size_t count, SourceSide side);

} // namespace mural::compositor
