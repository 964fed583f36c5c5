// 128-bit hash of a part of a plane. Different contents collide with probability 2^-128, so a tile with an unchanged
// hash need not be sent.
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
