// A kd-tree over the triangles of a mesh. Its leaves have an order: depth first, from the lower to the upper half of
// every split. A range of [0, 1) selects a contiguous run of leaves, so the tree divides a mesh for sort-last rendering
// and culls for sort-first rendering. Source: Bentley, "Multidimensional Binary Search Trees Used for Associative
// Searching", 1975; thesis, "Application Examples": eqPly.
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/range.hpp"
#include "examples/data/mesh.hpp"

namespace mural::examples {

// Smaller leaves cull better, larger ones need fewer draws. With the largest mesh of tools/example-data and four tiles,
// the busiest node needs .31 of the CPU time of one node with 1024 triangles, .34 with 2048, and .38 with 4096. One
// node needs the same time with all three.
constexpr uint32_t kMaxLeafTriangles = 1024;

struct Box {
    Point lowest{}, highest{};
    template <class Visit> void fields(Visit& visit) { visit(lowest, highest); }
    friend bool operator==(const Box&, const Box&) = default;
};

// A node of the tree. A node with one leaf is that leaf.
struct KdNode {
    Box box;
    uint32_t firstLeaf = 0, endLeaf = 0; // the leaves below this node
    uint32_t next = 0;                   // the node that follows the subtree, in depth-first order
    template <class Visit> void fields(Visit& visit) { visit(box, firstLeaf, endLeaf, next); }
    friend bool operator==(const KdNode&, const KdNode&) = default;
};

// Consecutive leaves: [first, end).
struct LeafRun {
    uint32_t first = 0, end = 0;
    friend bool operator==(const LeafRun&, const LeafRun&) = default;
};

class KdTree {
public:
    // Divides a mesh into leaves of at most `maxLeafTriangles` and nearly equal size. `order` receives the triangles of
    // the mesh in the order of the leaves. Requires at least one triangle.
    static KdTree build(const Mesh& mesh, std::vector<uint32_t>& order, uint32_t maxLeafTriangles = kMaxLeafTriangles);

    [[nodiscard]] const std::vector<KdNode>& nodes() const { return nodes_; }
    [[nodiscard]] uint32_t leaves() const { return static_cast<uint32_t>(leafEnds_.size()); }
    [[nodiscard]] uint64_t triangles() const { return leafEnds_.empty() ? 0 : leafEnds_.back(); }
    // The triangles of a leaf: [firstTriangle, endTriangle) of the order.
    [[nodiscard]] uint64_t firstTriangle(uint32_t leaf) const { return leaf == 0 ? 0 : leafEnds_[leaf - 1]; }
    [[nodiscard]] uint64_t endTriangle(uint32_t leaf) const { return leafEnds_[leaf]; }

    // Returns the leaves whose middle triangle lies in the range. Neighbouring ranges share no leaf and leave none out.
    [[nodiscard]] LeafRun leavesOf(const Range& range) const;

    // Calls use(leaf) for each leaf of the run, in the order of the leaves. Leaves with an outer box for which
    // isOutside(box) is true are left out.
    template <class IsOutside, class Use> void visit(const LeafRun& run, IsOutside&& isOutside, Use&& use) const {
        for (size_t n = 0; n < nodes_.size();) {
            const KdNode& node = nodes_[n];
            if (node.endLeaf <= run.first || node.firstLeaf >= run.end || isOutside(node.box)) {
                n = node.next > n ? node.next : nodes_.size();
                continue;
            }
            if (node.endLeaf - node.firstLeaf == 1) use(node.firstLeaf);
            ++n;
        }
    }

    template <class Visit> void fields(Visit& visit) { visit(nodes_, leafEnds_); }
    friend bool operator==(const KdTree&, const KdTree&) = default;

private:
    std::vector<KdNode> nodes_;      // depth first
    std::vector<uint64_t> leafEnds_; // end of each leaf in the order of triangles
};

} // namespace mural::examples
