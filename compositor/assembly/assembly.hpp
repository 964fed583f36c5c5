// Assembly of pictures: each function merges one picture into another. Sizes, formats and draw orders are checked. The
// result depends on the pictures and their draw orders only, never on the order of arrival.
#pragma once

#include "common/geometry/pixel_kernel.hpp"
#include "common/base/result.hpp"
#include "compositor/image/image.hpp"
#include "compositor/kernels/depth_function.hpp"
#include "compositor/kernels/mask_channels.hpp"

namespace mural::compositor {

// Sort-first and side-by-side stereo: copies the drawn pixels of `part`, in planes that both have.
[[nodiscard]] Result<void> assembleCopy(Image& into, const Image& part);

struct DepthAssembly {
    DepthFunction function = DepthFunction::Less;
    Coverage coverage = Coverage::All;
    uint32_t clearBits = 0; // for Coverage::NotClear
};
// Sort-last: composites by depth. Both need depth planes of one format and disjoint, not interleaved draw orders,
// because the draw order decides equal depths.
[[nodiscard]] Result<void> assembleDepth(Image& into, const Image& part, const DepthAssembly& how);

// Ordered blending of premultiplied colours; the later picture is in front. Draw orders must be adjacent, without a
// gap.
[[nodiscard]] Result<void> assembleBlended(Image& into, const Image& part);

// Pixel decomposition: writes the part's pixels to the kernel's positions. If the kernel does not divide the picture,
// the part may have one more column and row outside of it, which are ignored (common/geometry/pixel_kernel.hpp). Planes
// of one format.
[[nodiscard]] Result<void> interleavePixels(const MutablePlaneView& into, const PlaneView& part,
                                            const PixelKernel& kernel);
// The inverse: extracts the part. Pixels outside of the picture stay unchanged.
[[nodiscard]] Result<void> deinterleavePixels(const MutablePlaneView& part, const PlaneView& from,
                                              const PixelKernel& kernel);

struct ColourMask {
    bool red = true;
    bool green = true;
    bool blue = true;
    bool alpha = true;
};
[[nodiscard]] ChannelMask channelMaskOf(PlaneFormat format, const ColourMask& mask);
// Anaglyph: takes the masked components from `part`; the others stay. Planes of one colour format and size.
[[nodiscard]] Result<void> assembleMasked(const MutablePlaneView& into, const PlaneView& part, const ColourMask& mask);

} // namespace mural::compositor
