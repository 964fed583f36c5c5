// Bounding boxes of the vertex attributes of a draw, for the whole draw and for clusters of its primitives, from the
// bytes of its arrays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "nodes/culling/linear_view.hpp"

namespace mural::culling {

// One attribute in an array. Its components are consecutive inputs of the boxes.
struct AttributeArray {
    std::span<const std::byte> bytes; // begins with the element of vertex 0
    uint64_t strideBytes = 0;         // never 0
    uint32_t type = 0;                // as in GL: GL_FLOAT, GL_SHORT, …
    uint32_t components = 0;          // 1 to 4
    bool isNormalized = false;
};

// Bytes of one element; 0: the type has no boxes.
[[nodiscard]] uint32_t elementBytes(const AttributeArray& array);

// The vertices of a draw, in its order.
struct VertexSequence {
    uint64_t count = 0;
    int64_t first = 0;                  // added to each index, or the number of the first vertex
    std::span<const std::byte> indices; // `count` of them; empty without indices
    uint32_t indexBytes = 0;            // 1, 2 or 4; 0: no indices
    std::optional<uint32_t> restart;    // this index names no vertex
};

// Division of a draw into clusters, by its mode.
struct PrimitiveForm {
    uint32_t step = 0;    // vertices of a further primitive; 0: the draw has no clusters
    uint32_t overlap = 0; // vertices that a cluster shares with the next one
};
[[nodiscard]] PrimitiveForm formOf(uint32_t mode);

// Primitives of the clusters, from the smallest. All are even, because the faces of a strip alternate.
inline constexpr uint32_t kClusterPrimitives[] = {64, 256, 1024, 4096};
inline constexpr size_t kClusterLevels = std::size(kClusterPrimitives);

class DrawBoxes {
public:
    struct Level {
        uint64_t vertices = 0;     // step of a cluster, without the overlap
        std::vector<float> bounds; // lowest and highest inputs of each cluster
    };
    // whole: lowest and highest inputs, at most kMaxInputs each.
    DrawBoxes(size_t inputs, const std::vector<float>& whole, std::vector<Level> levels);

    [[nodiscard]] size_t inputs() const { return inputs_; }
    [[nodiscard]] const float* lowest() const { return whole_.data(); }
    [[nodiscard]] const float* highest() const { return whole_.data() + inputs_; }
    // From the smallest clusters; empty: the draw has none.
    [[nodiscard]] const std::vector<Level>& levels() const { return levels_; }
    [[nodiscard]] size_t clusters(size_t level) const { return levels_[level].bounds.size() / (2 * inputs_); }
    [[nodiscard]] const float* lowest(size_t level, size_t cluster) const {
        return levels_[level].bounds.data() + 2 * inputs_ * cluster;
    }
    [[nodiscard]] const float* highest(size_t level, size_t cluster) const { return lowest(level, cluster) + inputs_; }
    [[nodiscard]] size_t memoryBytes() const;

private:
    size_t inputs_;
    std::array<float, 2 * kMaxInputs> whole_{}; // in the object, for draws that are only decided as a whole
    std::vector<Level> levels_;
};

// Returns nothing if a vertex is not finite, if one is outside of its array, or if a type has no boxes.
[[nodiscard]] std::optional<DrawBoxes> makeBoxes(std::span<const AttributeArray> arrays, const VertexSequence& vertices,
                                                 PrimitiveForm form);

// Lowest and highest index that names a vertex, without `first`. Returns nothing if no index does.
struct IndexBounds {
    uint32_t lowest, highest;
};
[[nodiscard]] std::optional<IndexBounds> indexBounds(const VertexSequence& vertices);

} // namespace mural::culling
