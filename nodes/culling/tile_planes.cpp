#include "nodes/culling/tile_planes.hpp"

#include <algorithm>
#include <cmath>

namespace mural::culling {

namespace {

// Rounding of the driver's clipping and of its viewport transformation, in operations.
constexpr double kClipOperations = 8;
// Largest magnitude of a clip coordinate. Larger values may overflow in 32 bits.
constexpr double kMaxMagnitude = 1e30;

} // namespace

TilePlanes::TilePlanes(const LinearView& view, const ClipWindow& window, const PixelViewport& area, double marginPixels)
    : inputs_(view.inputs), isUsable_(window.width > 0 && window.height > 0) {
    const auto edge = [](double pixel, double origin, double size) { return (pixel - origin) * 2 / size - 1; };
    const double left = edge(area.x - marginPixels, window.x, window.width);
    const double right = edge(area.x + static_cast<double>(area.w) + marginPixels, window.x, window.width);
    const double bottom = edge(area.y - marginPixels, window.y, window.height);
    const double top = edge(area.y + static_cast<double>(area.h) + marginPixels, window.y, window.height);
    // sign * (coordinate - at * w)
    const auto make = [&](const LinearForm& coordinate, double at, double sign) {
        Side side;
        const auto widen = [&](double c, double cError, double w, double wError) {
            return cError + std::abs(at) * wError + kClipOperations * kRounding * (std::abs(c) + std::abs(at * w));
        };
        for (size_t i = 0; i < inputs_; ++i) {
            side.factor[i] = sign * (coordinate.factor[i] - at * view.w.factor[i]);
            side.error[i] = widen(coordinate.factor[i], coordinate.error[i], view.w.factor[i], view.w.error[i]);
        }
        side.constant = sign * (coordinate.constant - at * view.w.constant);
        side.constantError =
            widen(coordinate.constant, coordinate.constantError, view.w.constant, view.w.constantError);
        return side;
    };
    sides_ = {make(view.x, left, -1), make(view.x, right, 1), make(view.y, bottom, -1), make(view.y, top, 1)};
    for (const Side& side : sides_) {
        isUsable_ = isUsable_ && std::abs(side.constant) + side.constantError < kMaxMagnitude;
        for (size_t i = 0; i < inputs_; ++i)
            isUsable_ = isUsable_ && std::abs(side.factor[i]) + side.error[i] < kMaxMagnitude;
    }
}

Place TilePlanes::placeOf(const float* lowest, const float* highest) const {
    if (!isUsable_) return Place::Crossing;
    bool isInside = true;
    for (const Side& side : sides_) {
        double least = side.constant, greatest = side.constant, error = side.constantError, magnitude = 0;
        for (size_t i = 0; i < inputs_; ++i) {
            const double low = lowest[i], high = highest[i], factor = side.factor[i];
            const double a = factor * low, b = factor * high;
            least += a < b ? a : b;
            greatest += a < b ? b : a;
            const double most = std::max(std::abs(low), std::abs(high));
            error += side.error[i] * most;
            magnitude += most;
        }
        // Comparisons with NaN are false, and leave the box Crossing.
        if (least > error && magnitude < kMaxMagnitude) return Place::Outside;
        isInside = isInside && greatest <= -error;
    }
    return isInside ? Place::Inside : Place::Crossing;
}

} // namespace mural::culling
