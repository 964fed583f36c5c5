// A part of something as fractions of its size: lower left corner x, y, width, height. The whole is 0 0 1 1. Source:
// thesis, "Compounds": viewport. Conversion to pixels rounds positions and derives sizes from them, so adjacent parts
// meet.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/geometry/pixel_viewport.hpp"

namespace mural {

struct Viewport {
    double x = 0;
    double y = 0;
    double w = 1;
    double h = 1;

    [[nodiscard]] constexpr bool empty() const { return !(w > 0) || !(h > 0); }
    [[nodiscard]] constexpr bool full() const { return x == 0 && y == 0 && w == 1 && h == 1; }
    friend constexpr bool operator==(const Viewport&, const Viewport&) = default;
};

// Returns `inner`, which is relative to `outer`, relative to the whole.
[[nodiscard]] constexpr Viewport compose(const Viewport& outer, const Viewport& inner) {
    return {outer.x + inner.x * outer.w, outer.y + inner.y * outer.h, inner.w * outer.w, inner.h * outer.h};
}

// Returns `part` relative to `whole`; both are parts of the same thing. Requires a non-empty `whole`.
[[nodiscard]] constexpr Viewport relativeTo(const Viewport& part, const Viewport& whole) {
    return {(part.x - whole.x) / whole.w, (part.y - whole.y) / whole.h, part.w / whole.w, part.h / whole.h};
}

// Returns the intersection; empty if there is none. Overlaps below the rounding error of decimal fractions (.1 + .7 is
// not .8) count as none.
[[nodiscard]] constexpr Viewport intersect(const Viewport& a, const Viewport& b) {
    constexpr double kNothing = 1e-9;
    const auto size = [](double from, double a0, double aSize, double b0, double bSize) {
        if (from == a0 && a0 + aSize <= b0 + bSize) return aSize; // exact
        if (from == b0 && b0 + bSize <= a0 + aSize) return bSize;
        return std::min(a0 + aSize, b0 + bSize) - from;
    };
    const double x0 = std::max(a.x, b.x);
    const double y0 = std::max(a.y, b.y);
    const double w = size(x0, a.x, a.w, b.x, b.w);
    const double h = size(y0, a.y, a.h, b.y, b.h);
    if (!(w > kNothing) || !(h > kNothing)) return {0, 0, 0, 0};
    return {x0, y0, w, h};
}

// Returns the pixel that contains a fractional position. A position within rounding error of a pixel's edge is on the
// edge, so .1 + .7 and .8 are the same edge.
[[nodiscard]] inline int32_t pixelEdge(double fraction, int32_t size) {
    constexpr double kRoundingPixels = 1e-6;
    const double edge = std::trunc(fraction * size + kRoundingPixels);
    return static_cast<int32_t>(std::clamp(edge, double{INT32_MIN / 2}, double{INT32_MAX / 2}));
}

// Returns the pixels of a part of `whole`. Parts with equal decimal edges neither overlap nor leave a gap.
[[nodiscard]] inline PixelViewport apply(const PixelViewport& whole, const Viewport& part) {
    const int32_t x0 = pixelEdge(part.x, whole.w);
    const int32_t y0 = pixelEdge(part.y, whole.h);
    return {whole.x + x0, whole.y + y0, pixelEdge(part.x + part.w, whole.w) - x0,
            pixelEdge(part.y + part.h, whole.h) - y0};
}

// Returns the pixels of `part` relative to `whole`. Requires a non-empty `whole`.
[[nodiscard]] constexpr Viewport relativeTo(const PixelViewport& part, const PixelViewport& whole) {
    if (part == whole) return {};
    const double w = whole.w, h = whole.h;
    return {(part.x - whole.x) / w, (part.y - whole.y) / h, part.w / w, part.h / h};
}

} // namespace mural
