// Areas and zooms of the nodes, for sessions in which they change (HeadCommand::ViewportAssignment).
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
    std::vector<double> zooms;     // per node, relative to the zoom of Setup, at most 1; empty: 1 for all

    [[nodiscard]] double zoomOf(size_t node) const { return node < zooms.size() ? zooms[node] : 1; }

    friend bool operator==(const ViewportAssignment&, const ViewportAssignment&) = default;
};

// u32 number, u32 nodes, then five doubles per node: x, y, w, h, zoom.
std::vector<std::byte> bytesOf(const ViewportAssignment& areas);

// Parses areas at the start of `bytes` and removes them. Returns nothing if truncated, if an area exceeds the picture,
// or if a zoom is not in (0, 1].
std::optional<ViewportAssignment> takeAreas(std::span<const std::byte>& bytes);

} // namespace mural
