// Selects the vertices of a draw that may touch an area: nothing, everything, or ranges of whole clusters in their
// order.
#pragma once

#include <cstdint>
#include <vector>

#include "nodes/culling/tile_planes.hpp"
#include "nodes/culling/vertex_boxes.hpp"

namespace mural::culling {

// Ranges beyond this number cost more than they save.
inline constexpr size_t kMaxRanges = 256;

struct VertexRange {
    uint64_t first, count;
    friend bool operator==(const VertexRange&, const VertexRange&) = default;
};

enum class Cut : uint8_t { Nothing, Ranges, Whole };

// Decides a draw of `vertices` vertices. canCut: the rules for its state allow parts. On Ranges, `ranges` has the kept
// parts, with at most kMaxRanges elements.
[[nodiscard]] Cut cutDraw(const DrawBoxes& boxes, const TilePlanes& planes, uint64_t vertices, PrimitiveForm form,
                          bool canCut, std::vector<VertexRange>& ranges);

} // namespace mural::culling
