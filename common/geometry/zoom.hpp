// Ratio of the drawn to the shown size of a picture. Source: thesis, "Compounds": zoom.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/geometry/pixel_viewport.hpp"

namespace mural {

constexpr double kMaxZoom = 16; // bounded by the framebuffer of a part of a window

struct Zoom {
    double x = 1;
    double y = 1;

    [[nodiscard]] constexpr bool valid() const { return x > 0 && y > 0; }
    [[nodiscard]] constexpr bool none() const { return x == 1 && y == 1; }
    friend constexpr bool operator==(const Zoom&, const Zoom&) = default;
};

[[nodiscard]] constexpr Zoom compose(const Zoom& a, const Zoom& b) { return {a.x * b.x, a.y * b.y}; }

[[nodiscard]] inline PixelViewport apply(const PixelViewport& area, const Zoom& zoom) {
    const auto scaled = [](int32_t value, double by) {
        return static_cast<int32_t>(
            std::clamp(std::trunc(value * by + .5), double{INT32_MIN / 2}, double{INT32_MAX / 2}));
    };
    return {scaled(area.x, zoom.x), scaled(area.y, zoom.y), scaled(area.w, zoom.x), scaled(area.h, zoom.y)};
}

} // namespace mural
