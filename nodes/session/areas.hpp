// Which part of the picture each node draws, where that may change while the session runs (HeadCommand::Areas).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/viewport.hpp"

namespace mural {

struct Areas {
    uint32_t number = 0;          // 0: those of the start; later ones are larger
    std::vector<Viewport> ofNodes; // by node; neighbours have the same edges, bit for bit

    friend bool operator==(const Areas&, const Areas&) = default;
};

// u32 number, u32 nodes, then of each four doubles: x, y, w, h.
std::vector<std::byte> bytesOf(const Areas& areas);

// The first areas in `bytes`, which then begins behind them. None: it is too short, or some area is not one within the picture.
std::optional<Areas> takeAreas(std::span<const std::byte>& bytes);

} // namespace mural
