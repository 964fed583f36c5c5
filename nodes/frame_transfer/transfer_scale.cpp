#include "nodes/frame_transfer/transfer_scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "nodes/frame_transfer/scale_picture.hpp"

namespace mural {

ScaledSize scaledSizeOf(int32_t w, int32_t h, const Zoom& transferScale) {
    const auto smaller = [](int32_t size, double by) {
        return size <= 0 ? 0 : std::clamp(static_cast<int32_t>(std::lround(size * by)), 1, size);
    };
    return {smaller(w, transferScale.x), smaller(h, transferScale.y)};
}

void resizePicture(const std::byte* from, int32_t w, int32_t h, std::byte* into, int32_t toW, int32_t toH) {
    const PixelViewport all{0, 0, toW, toH};
    if (w <= 0 || h <= 0 || all.empty()) return;
    if (w == toW && h == toH)
        std::memcpy(into, from, ScaledSize{w, h}.bytes());
    else
        scalePicture({from, {0, 0, w, h}}, {static_cast<double>(w) / toW, static_cast<double>(h) / toH}, all, into,
                     all);
}

} // namespace mural
