// The triangles of one leaf as bytes that a GL buffer takes: vertices, then indices of 16 bits. A leaf has its own
// vertices, so it can be loaded and drawn alone.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "examples/data/mesh.hpp"

namespace mural::examples {

struct LeafVertex {
    Point position;
    std::array<int16_t, 4> normal; // scaled by 32767; the last is 0
    Colour colour;
};
static_assert(sizeof(LeafVertex) == 24);

// A packed leaf: a header of 16 bytes, the vertices, the indices.
struct LeafView {
    std::span<const LeafVertex> vertices;
    std::span<const uint16_t> indices;
};

// Returns the packed triangles of a mesh. Without colours in the mesh, vertices are white. Requires at most 21 845
// triangles, so that indices have 16 bits.
std::vector<std::byte> packLeaf(const Mesh& mesh, std::span<const uint32_t> triangles);
// Returns the parts of a packed leaf, or nothing if the bytes are none. Requires an alignment of 4.
std::optional<LeafView> viewLeaf(std::span<const std::byte> bytes);

} // namespace mural::examples
