#include "nodes/player/pixel_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mural {

namespace {

// The first pixel of a kernel's column at or after a window position.
int64_t firstBehind(int64_t at, int column, int columns) {
    const int64_t n = at - column;
    return n > 0 ? (n + columns - 1) / columns : -(-n / columns);
}

// The first pixel of a zoomed picture whose centre is at or after an edge.
int64_t zoomed(int64_t edge, double zoom) {
    return zoom == 1 ? edge : static_cast<int64_t>(std::ceil(static_cast<double>(edge) * zoom - 0.5));
}

int32_t narrow(int64_t value) { return static_cast<int32_t>(std::clamp<int64_t>(value, INT32_MIN, INT32_MAX)); }

} // namespace

std::array<double, 2> placeInPass(const RenderPass& p, double x, double y) {
    const auto jitter = jitterOf(p.sample, p.samples);
    return {((x - p.kernelX - 0.5 - jitter[0]) / p.kernelWidth + 0.5) * p.zoom.x,
            ((y - p.kernelY - 0.5 - jitter[1]) / p.kernelHeight + 0.5) * p.zoom.y};
}

PassMapping passToWindow(const RenderPass& p) {
    return {{p.kernelWidth / p.zoom.x, p.kernelHeight / p.zoom.y},
            {p.kernelX + 0.5 * (1 - p.kernelWidth), p.kernelY + 0.5 * (1 - p.kernelHeight)}};
}

PixelViewport inKernel(const RenderPass& p, const PixelViewport& r) {
    const int64_t x0 = firstBehind(r.x, p.kernelX, p.kernelWidth),
                  x1 = firstBehind(int64_t{r.x} + r.w, p.kernelX, p.kernelWidth);
    const int64_t y0 = firstBehind(r.y, p.kernelY, p.kernelHeight),
                  y1 = firstBehind(int64_t{r.y} + r.h, p.kernelY, p.kernelHeight);
    return {narrow(x0), narrow(y0), narrow(x1 - x0), narrow(y1 - y0)};
}

PixelViewport shownByKernel(const RenderPass& p, const PixelViewport& r) {
    return {r.x * p.kernelWidth + p.kernelX, r.y * p.kernelHeight + p.kernelY, (r.w - 1) * p.kernelWidth + 1,
            (r.h - 1) * p.kernelHeight + 1};
}

PixelViewport inPass(const RenderPass& p, const PixelViewport& r) {
    const PixelViewport k = inKernel(p, r);
    const int64_t x0 = zoomed(k.x, p.zoom.x), y0 = zoomed(k.y, p.zoom.y);
    return {narrow(x0), narrow(y0), narrow(zoomed(int64_t{k.x} + k.w, p.zoom.x) - x0),
            narrow(zoomed(int64_t{k.y} + k.h, p.zoom.y) - y0)};
}

PixelViewport inShown(const RenderPass& pass, const PixelViewport& r) {
    RenderPass shown = pass;
    shown.zoom = pass.shown;
    return inPass(shown, r);
}

PassPixel standingFor(const RenderPass& p, int32_t x, int32_t y) {
    return {static_cast<int32_t>((x / p.kernelWidth + 0.5) * p.zoom.x),
            static_cast<int32_t>((y / p.kernelHeight + 0.5) * p.zoom.y)};
}

PixelViewport standingFor(const RenderPass& p, const PixelViewport& r) {
    const PassPixel first = standingFor(p, r.x, r.y), last = standingFor(p, r.right() - 1, r.top() - 1);
    return {first.x, first.y, last.x - first.x + 1, last.y - first.y + 1};
}

std::array<float, 4> moveInViewport(const RenderPass& p, const std::array<float, 4>& v) {
    if (!(v[2] > 0) || !(v[3] > 0)) return {};
    // x' = a x + b in window coordinates, x = v + (n + 1) w / 2 for normalised n.
    const auto zero = placeInPass(p, 0, 0);
    const double ax = p.zoom.x / p.kernelWidth, ay = p.zoom.y / p.kernelHeight;
    return {static_cast<float>(ax - 1), static_cast<float>(ay - 1),
            static_cast<float>(2 * (ax * v[0] + zero[0] - v[0]) / v[2] + ax - 1),
            static_cast<float>(2 * (ay * v[1] + zero[1] - v[1]) / v[3] + ay - 1)};
}

} // namespace mural
