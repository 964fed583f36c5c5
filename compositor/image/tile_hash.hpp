// A name for what a part of a plane holds: equal pixels have equal names, and two different ones share theirs by chance in one
// of 2^128 cases, so a tile whose name is the old one needs not be sent again.
#pragma once

#include <cstdint>

#include "compositor/image/plane.hpp"

namespace mural::compositor {

struct TileHash {
    uint64_t low = 0;
    uint64_t high = 0;
    friend bool operator==(const TileHash&, const TileHash&) = default;
};

[[nodiscard]] TileHash hashOf(const PlaneView& tile);

} // namespace mural::compositor
