// Regions that end on the bins of a software rasteriser.
//
// llvmpipe sorts the commands of a scene into bins of 64x64 pixels. Framebuffers without depth and stencil buffers have
// another code path for bins that contain only rectangles. Its colours differ by 1 to 3. A scissor edge inside a bin
// keeps commands out of it, and so changes the path of its other pixels. Multisampled lines also round differently at
// scissor edges inside a bin. A region of whole bins has the same commands in each of them as the whole picture.
#pragma once

#include <cstdint>

#include "common/geometry/pixel_viewport.hpp"

namespace mural {

inline constexpr int32_t kBinPixels = 64;

// The smallest rectangle of whole bins that holds `region`, cut to `surface`. Empty regions stay empty. Bins count from
// the upper left corner of the surface: Mesa stores framebuffers of windows and pbuffers with their top row first.
[[nodiscard]] constexpr PixelViewport widenToBins(const PixelViewport& region, const PixelViewport& surface) {
    const PixelViewport inside = intersect(region, surface);
    if (inside.empty()) return {};
    const auto down = [](int32_t pixels) { return pixels / kBinPixels * kBinPixels; };
    const auto up = [&](int32_t pixels) { return down(pixels + kBinPixels - 1); };
    const int32_t left = down(inside.x - surface.x), right = up(inside.right() - surface.x);
    const int32_t above = down(surface.top() - inside.top()), below = up(surface.top() - inside.y);
    return intersect({surface.x + left, surface.top() - below, right - left, below - above}, surface);
}

} // namespace mural
