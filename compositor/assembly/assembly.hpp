// Puts pictures together: each function takes one more picture into what is there. Sizes, formats and draw orders are checked;
// what comes out depends on the pictures and their orders only, never on which of them came first.
#pragma once

#include "common/pixel_kernel.hpp"
#include "common/result.hpp"
#include "compositor/image/image.hpp"
#include "compositor/kernels/depth_function.hpp"
#include "compositor/kernels/mask_channels.hpp"

namespace mural::compositor {

// Sort-first and stereo side by side: the drawn pixels of `part`, planes that both have.
[[nodiscard]] Result<void> assembleCopy(Image& into, const Image& part);

struct DepthAssembly {
    DepthFunction function = DepthFunction::Less;
    Coverage coverage = Coverage::All;
    uint32_t clearBits = 0; // for Coverage::NotClear
};
// Sort-last: both have depth planes of one format. Their orders must be apart: neither may lie in between the other's parts,
// for where depths tie, the draw order decides.
[[nodiscard]] Result<void> assembleDepth(Image& into, const Image& part, const DepthAssembly& how);

// Premultiplied colours; the later picture is in front. Orders must be adjacent: nothing may be missing in between.
[[nodiscard]] Result<void> assembleBlended(Image& into, const Image& part);

// Pixel decomposition: the part's pixels are those of the kernel. It may have a column and a row more, which stand outside of
// the picture where the kernel does not divide it (common/pixel_kernel.hpp); they are left out. Planes of one format.
[[nodiscard]] Result<void> interleavePixels(const MutablePlaneView& into, const PlaneView& part, const PixelKernel& kernel);
// The other way: takes the part out of a picture. What of it stands outside stays as it is.
[[nodiscard]] Result<void> deinterleavePixels(const MutablePlaneView& part, const PlaneView& from, const PixelKernel& kernel);

struct ColourMask {
    bool red = true;
    bool green = true;
    bool blue = true;
    bool alpha = true;
};
[[nodiscard]] ChannelMask channelMaskOf(PlaneFormat format, const ColourMask& mask);
// Anaglyph: the masked components are taken from `part`, the others stay. Planes of one colour format and size.
[[nodiscard]] Result<void> assembleMasked(const MutablePlaneView& into, const PlaneView& part, const ColourMask& mask);

} // namespace mural::compositor
