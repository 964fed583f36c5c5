// Classifies planes, or parts of them, by the behaviour of codecs. Samples few pixels, so the cost is negligible.
#pragma once

#include <compare>
#include <cstdint>

#include "compositor/image/plane.hpp"

namespace mural::compositor {

// Fraction of sampled pixels that differ from the pixel above.
enum class Activity : uint8_t {
    Empty, // none
    Flat,  // fewer than three in eight
    Full,
};

// Kind of the differences: bit planes suit the first kind, match search the others.
enum class Change : uint8_t {
    Smooth,   // mostly small
    Repeated, // half of them equal the pixel to the left
    Sharp,
};

struct TileClass {
    PlaneFormat format = PlaneFormat::Rgba8;
    Activity activity = Activity::Full;
    Change change = Change::Sharp;                                         // Smooth if no pixel differs
    friend auto operator<=>(const TileClass&, const TileClass&) = default; // NOLINT(modernize-use-nullptr): no pointer
};

[[nodiscard]] TileClass classify(const PlaneView& plane);

} // namespace mural::compositor
