// Which part of a picture's draws, in their order, each node draws, where that may change while the session runs (HeadCommand::Shares).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/range.hpp"

namespace mural {

struct Shares {
    uint32_t number = 0;        // 0: those of the start; later ones are larger
    std::vector<Range> ofNodes; // by node; neighbours have the same edges, bit for bit

    friend bool operator==(const Shares&, const Shares&) = default;
};

// u32 number, u32 nodes, then of each two doubles: start, end.
std::vector<std::byte> bytesOf(const Shares& shares);

// None: these bytes are no shares, or one is not within the draws.
std::optional<Shares> sharesOf(std::span<const std::byte> bytes);

} // namespace mural
