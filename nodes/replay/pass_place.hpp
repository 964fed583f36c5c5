// Where the pixels of a pass lie in the picture of a frame (nodes/session/render_pass.hpp).
#pragma once

#include <array>

#include "common/pixel_viewport.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// Where window coordinates of the whole picture lie in this pass's: pixel i of a kernel of n columns shows what is at
// n i + its column + 1/2, and a sample what lies off its pixel's centre.
[[nodiscard]] std::array<double, 2> placeInPass(const RenderPass& pass, double x, double y);

// And back, for the pixels' centres: what a fragment at x, y of the pass's picture is asked to draw lies at scale x + from. A sample is asked
// for its whole pixel, as when the program draws it with another viewport.
struct PassToWindow {
    std::array<double, 2> scale{}, from{};
};
[[nodiscard]] PassToWindow passToWindow(const RenderPass& pass);

// Which pixels of the pass's picture show what is in `r` of the window.
[[nodiscard]] PixelViewport inKernel(const RenderPass& pass, const PixelViewport& r);

// The same where the pass is zoomed, too: pixel i is drawn as what lies at (i + 1/2) / zoom, and belongs to what has its middle.
[[nodiscard]] PixelViewport inPass(const RenderPass& pass, const PixelViewport& r);

// The same in the picture that it hands out.
[[nodiscard]] PixelViewport inShown(const RenderPass& pass, const PixelViewport& r);

// From the first to the last pixel of the window that pixels `r` of the pass show; without zoom.
[[nodiscard]] PixelViewport shownByKernel(const RenderPass& pass, const PixelViewport& r);

// The pass's pixel that stands for one of the window: for those of its kernel, or that it is drawn for.
struct PassPixel {
    int32_t x, y;
};
[[nodiscard]] PassPixel standingFor(const RenderPass& pass, int32_t x, int32_t y);
// Those that stand for the pixels `r` of the window.
[[nodiscard]] PixelViewport standingFor(const RenderPass& pass, const PixelViewport& r);

// What moves positions so within a viewport x, y, width, height: scale - 1 in x, y, then offset in x, y, of normalised
// device coordinates (shaders::kMoveUniform).
[[nodiscard]] std::array<float, 4> moveInViewport(const RenderPass& pass, const std::array<float, 4>& viewport);

} // namespace mural
