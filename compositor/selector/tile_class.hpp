// Sorts planes, or parts of them, by what codecs make of them: a sample of pixels is looked at, so it costs next to nothing.
#pragma once

#include <compare>
#include <cstdint>

#include "compositor/image/plane.hpp"

namespace mural::compositor {

enum class Activity : uint8_t {
    Empty,  // all pixels of the sample are those above them
    Still,  // nearly all are
    Flat,   // most are
    Smooth, // most are near
    Busy,
};

struct TileClass {
    PlaneFormat format = PlaneFormat::Rgba8;
    Activity activity = Activity::Busy;
    friend auto operator<=>(const TileClass&, const TileClass&) = default;
};

[[nodiscard]] TileClass classify(const PlaneView& plane);

} // namespace mural::compositor
