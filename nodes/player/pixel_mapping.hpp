// Converts between window coordinates and the coordinates of a pass (nodes/session/render_pass.hpp).
#pragma once

#include <array>

#include "common/geometry/pixel_viewport.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// Converts window coordinates to the pass's. Pixel i of the pass, with a kernel of n columns, shows the window at n * i
// + its column + 1/2. A pass for a sample shows a position beside the pixel's centre.
[[nodiscard]] std::array<double, 2> placeInPass(const RenderPass& pass, double x, double y);

// The inverse for pixel centres: a fragment at x, y of the pass lies at scale * (x, y) + from in the window. A pass for
// a sample represents whole pixels, so the offset of the sample is not included.
struct PassMapping {
    std::array<double, 2> scale{}, from{};
};
[[nodiscard]] PassMapping passToWindow(const RenderPass& pass);

// Returns the pixels of the pass that show window pixels in `r`, without zoom.
[[nodiscard]] PixelViewport inKernel(const RenderPass& pass, const PixelViewport& r);

// Returns the pixels of the pass that show `r`, with zoom. Pixel i shows the window at (i + 1/2) / zoom, and belongs to
// the rectangle that contains its centre.
[[nodiscard]] PixelViewport inPass(const RenderPass& pass, const PixelViewport& r);

// Returns these pixels in the picture that the pass outputs.
[[nodiscard]] PixelViewport inShown(const RenderPass& pass, const PixelViewport& r);

// Returns the bounding box of the window pixels that pixels `r` of the pass show, without zoom.
[[nodiscard]] PixelViewport shownByKernel(const RenderPass& pass, const PixelViewport& r);

// The pixel of the pass that represents a window pixel: it shows the pixel itself, or another pixel of its kernel
// block.
struct PassPixel {
    int32_t x, y;
};
[[nodiscard]] PassPixel standingFor(const RenderPass& pass, int32_t x, int32_t y);
// Returns the pixels that represent the window pixels `r`.
[[nodiscard]] PixelViewport standingFor(const RenderPass& pass, const PixelViewport& r);

// Returns the transformation of window coordinates to the pass, for a viewport x, y, width, height. The values are
// scale - 1 in x, y, then offset in x, y, in normalised device coordinates (shaders::kMoveUniform).
[[nodiscard]] std::array<float, 4> moveInViewport(const RenderPass& pass, const std::array<float, 4>& viewport);

} // namespace mural
