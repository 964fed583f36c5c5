// The planes of an area of the picture in clip space, and tests of boxes of vertex attributes against them.
//
// A primitive is outside if all its vertices are beyond one and the same plane. Clip space is linear, so this also
// holds for vertices with w <= 0, and for the points at which a driver clips the primitive.
#pragma once

#include <array>
#include <cstdint>

#include "common/geometry/pixel_viewport.hpp"
#include "nodes/culling/linear_view.hpp"

namespace mural::culling {

// The viewport of the draw, in window coordinates.
struct ClipWindow {
    double x = 0, y = 0, width = 0, height = 0;
};

enum class Place : uint8_t {
    Outside,  // beyond one plane, rounding included: no pixel of the area can change
    Crossing, // unknown
    Inside    // between all planes
};

class TilePlanes {
public:
    // marginPixels: distance by which the planes are outside of the area's edges. Planes that are not finite make every
    // box Crossing.
    TilePlanes(const LinearView& view, const ClipWindow& window, const PixelViewport& area, double marginPixels);

    [[nodiscard]] size_t inputs() const { return inputs_; }
    // lowest, highest: the bounds of each input.
    [[nodiscard]] Place placeOf(const float* lowest, const float* highest) const;

private:
    // Positive beyond the plane.
    struct Side {
        std::array<double, kMaxInputs> factor{}, error{};
        double constant = 0, constantError = 0;
    };
    size_t inputs_;
    bool isUsable_;
    std::array<Side, 4> sides_;
};

} // namespace mural::culling
