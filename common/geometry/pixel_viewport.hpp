// Integer rectangles in window coordinates: lower left corner x, y, width, height, in pixels. Source: thesis,
// "Compounds": pixel viewport.
#pragma once

#include <algorithm>
#include <cstdint>

namespace mural {

struct PixelViewport {
    int32_t x = 0;
    int32_t y = 0;
    int32_t w = 0;
    int32_t h = 0;

    [[nodiscard]] constexpr bool empty() const { return w <= 0 || h <= 0; }
    [[nodiscard]] constexpr int64_t area() const { return empty() ? 0 : static_cast<int64_t>(w) * h; }
    // Saturates at the range of int32_t, because programs may request any size.
    [[nodiscard]] constexpr int32_t right() const { return end(x, w); }
    [[nodiscard]] constexpr int32_t top() const { return end(y, h); }
    [[nodiscard]] static constexpr int32_t end(int32_t from, int32_t size) {
        return static_cast<int32_t>(std::clamp<int64_t>(int64_t{from} + size, INT32_MIN, INT32_MAX));
    }
    [[nodiscard]] constexpr bool contains(const PixelViewport& o) const {
        return o.x >= x && o.y >= y && o.right() <= right() && o.top() <= top();
    }
    friend constexpr bool operator==(const PixelViewport&, const PixelViewport&) = default;
};

// Returns the intersection; w = h = 0 if it is empty.
[[nodiscard]] constexpr PixelViewport intersect(const PixelViewport& a, const PixelViewport& b) {
    const int32_t x0 = std::max(a.x, b.x);
    const int32_t y0 = std::max(a.y, b.y);
    const int32_t x1 = std::min(a.right(), b.right());
    const int32_t y1 = std::min(a.top(), b.top());
    if (x1 <= x0 || y1 <= y0) return {};
    return {x0, y0, x1 - x0, y1 - y0};
}

// Returns the bounding box; empty operands do not count.
[[nodiscard]] constexpr PixelViewport unite(const PixelViewport& a, const PixelViewport& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    const int32_t x0 = std::min(a.x, b.x);
    const int32_t y0 = std::min(a.y, b.y);
    return {x0, y0, std::max(a.right(), b.right()) - x0, std::max(a.top(), b.top()) - y0};
}

} // namespace mural
