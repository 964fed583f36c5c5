// Shares of a picture's draws, one per node, for sessions in which shares change (HeadCommand::RangeAssignment).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/range.hpp"

namespace mural {

struct RangeAssignment {
    uint32_t number = 0;        // 0: the initial shares; increases
    std::vector<Range> ofNodes; // per node; neighbours share bit-identical edges

    friend bool operator==(const RangeAssignment&, const RangeAssignment&) = default;
};

// u32 number, u32 nodes, then two doubles per node: start, end.
std::vector<std::byte> bytesOf(const RangeAssignment& shares);

// Returns nothing for malformed bytes, or if a share exceeds the draws.
std::optional<RangeAssignment> sharesOf(std::span<const std::byte> bytes);

} // namespace mural
