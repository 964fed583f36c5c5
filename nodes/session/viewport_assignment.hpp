// Areas of the nodes, for sessions in which areas change (HeadCommand::ViewportAssignment).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/viewport.hpp"

namespace mural {

struct ViewportAssignment {
    uint32_t number = 0;           // 0: the initial areas; increases
    std::vector<Viewport> ofNodes; // per node; neighbours share bit-identical edges

    friend bool operator==(const ViewportAssignment&, const ViewportAssignment&) = default;
};

// u32 number, u32 nodes, then four doubles per node: x, y, w, h.
std::vector<std::byte> bytesOf(const ViewportAssignment& areas);

// Parses areas at the start of `bytes` and removes them. Returns nothing if truncated, or if an area exceeds the
// picture.
std::optional<ViewportAssignment> takeAreas(std::span<const std::byte>& bytes);

} // namespace mural
