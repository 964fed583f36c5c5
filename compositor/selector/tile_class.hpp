// Sorts planes, or parts of them, by what codecs make of them: a sample of pixels is looked at, so it costs next to nothing.
#pragma once

#include <compare>
#include <cstdint>

#include "compositor/image/plane.hpp"

namespace mural::compositor {

// How many pixels differ from those above them.
enum class Activity : uint8_t {
    Empty, // none of the sample
    Flat,  // fewer than three in eight
    Full,
};

// How those differ that do: bit planes are good at the first kind, searching for what was there before at the others.
enum class Change : uint8_t {
    Smooth,   // most by little
    Repeated, // half of them are those on their left
    Sharp,
};

struct TileClass {
    PlaneFormat format = PlaneFormat::Rgba8;
    Activity activity = Activity::Full;
    Change change = Change::Sharp; // Smooth where none differs
    friend auto operator<=>(const TileClass&, const TileClass&) = default;
};

[[nodiscard]] TileClass classify(const PlaneView& plane);

} // namespace mural::compositor
