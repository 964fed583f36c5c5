#include "nodes/replay/pass_place.hpp"

#include <algorithm>
#include <cstdint>

namespace mural {

namespace {

// The first pixel of a kernel's column at or behind a place of the window.
int64_t firstBehind(int64_t at, int column, int columns) {
    const int64_t n = at - column;
    return n > 0 ? (n + columns - 1) / columns : -(-n / columns);
}

int32_t narrow(int64_t value) { return static_cast<int32_t>(std::clamp<int64_t>(value, INT32_MIN, INT32_MAX)); }

} // namespace

std::array<double, 2> placeInPass(const RenderPass& p, double x, double y) {
    const auto jitter = jitterOf(p.sample, p.samples);
    return {(x - p.kernelX - 0.5 - jitter[0]) / p.kernelWidth + 0.5, (y - p.kernelY - 0.5 - jitter[1]) / p.kernelHeight + 0.5};
}

PixelViewport inKernel(const RenderPass& p, const PixelViewport& r) {
    const int64_t x0 = firstBehind(r.x, p.kernelX, p.kernelWidth), x1 = firstBehind(int64_t{r.x} + r.w, p.kernelX, p.kernelWidth);
    const int64_t y0 = firstBehind(r.y, p.kernelY, p.kernelHeight), y1 = firstBehind(int64_t{r.y} + r.h, p.kernelY, p.kernelHeight);
    return {narrow(x0), narrow(y0), narrow(x1 - x0), narrow(y1 - y0)};
}

PixelViewport shownByKernel(const RenderPass& p, const PixelViewport& r) {
    return {r.x * p.kernelWidth + p.kernelX, r.y * p.kernelHeight + p.kernelY, (r.w - 1) * p.kernelWidth + 1, (r.h - 1) * p.kernelHeight + 1};
}

PixelViewport standingFor(const RenderPass& p, const PixelViewport& r) {
    const int32_t x = r.x / p.kernelWidth, y = r.y / p.kernelHeight;
    return {x, y, (r.right() - 1) / p.kernelWidth - x + 1, (r.top() - 1) / p.kernelHeight - y + 1};
}

std::array<float, 4> moveInViewport(const RenderPass& p, const std::array<float, 4>& v) {
    if (!(v[2] > 0) || !(v[3] > 0)) return {};
    // x' = a x + b in window coordinates, x = v + (n + 1) w / 2 for normalised n.
    const auto zero = placeInPass(p, 0, 0);
    const double ax = 1.0 / p.kernelWidth, ay = 1.0 / p.kernelHeight;
    return {static_cast<float>(ax - 1), static_cast<float>(ay - 1), static_cast<float>(2 * (ax * v[0] + zero[0] - v[0]) / v[2] + ax - 1),
            static_cast<float>(2 * (ay * v[1] + zero[1] - v[1]) / v[3] + ay - 1)};
}

} // namespace mural
