#include "examples/ply/kd_tree.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace mural::examples {
namespace {

void extend(Box& box, const Point& point) {
    for (size_t k = 0; k < 3; ++k) {
        box.lowest[k] = std::min(box.lowest[k], point[k]);
        box.highest[k] = std::max(box.highest[k], point[k]);
    }
}

size_t longestAxis(const Box& box) {
    size_t longest = 0;
    for (size_t k = 1; k < 3; ++k) {
        if (box.highest[k] - box.lowest[k] > box.highest[longest] - box.lowest[longest]) longest = k;
    }
    return longest;
}

// Splits runs of triangles until a run fits into a leaf.
class Builder {
public:
    Builder(const Mesh& mesh, std::span<uint32_t> order) : mesh_(mesh), order_(order) {
        centres_.reserve(mesh.triangles());
        for (size_t t = 0; t < mesh.triangles(); ++t) {
            Point sum{};
            for (size_t corner = 0; corner < 3; ++corner) {
                const Point& p = cornerOf(t, corner);
                for (size_t k = 0; k < 3; ++k) sum[k] += p[k] / 3;
            }
            centres_.push_back(sum);
        }
    }

    // Adds the subtree of `leafCount` leaves of the triangles [begin, end) of the order. The depth is logarithmic.
    void add(size_t begin, size_t end, uint32_t leafCount) {
        const size_t n = nodes.size();
        const auto firstLeaf = static_cast<uint32_t>(leafEnds.size());
        nodes.push_back({boxOf(begin, end), firstLeaf, firstLeaf + leafCount, 0});
        if (leafCount == 1) {
            leafEnds.push_back(end);
        } else {
            const uint32_t lower = leafCount / 2;
            const size_t middle = begin + (end - begin) * lower / leafCount;
            split(begin, middle, end);
            add(begin, middle, lower);
            add(middle, end, leafCount - lower);
        }
        nodes[n].next = static_cast<uint32_t>(nodes.size());
    }

    std::vector<KdNode> nodes;
    std::vector<uint64_t> leafEnds;

private:
    [[nodiscard]] const Point& cornerOf(size_t triangle, size_t corner) const {
        return mesh_.positions[mesh_.indices[3 * triangle + corner]];
    }
    [[nodiscard]] Box boxOf(size_t begin, size_t end) const {
        Box box{cornerOf(order_[begin], 0), cornerOf(order_[begin], 0)};
        for (size_t at = begin; at < end; ++at) {
            for (size_t corner = 0; corner < 3; ++corner) extend(box, cornerOf(order_[at], corner));
        }
        return box;
    }
    void split(size_t begin, size_t middle, size_t end) {
        Box box{centres_[order_[begin]], centres_[order_[begin]]};
        for (size_t at = begin; at < end; ++at) extend(box, centres_[order_[at]]);
        const size_t axis = longestAxis(box);
        const auto at = [&](size_t position) { return order_.begin() + static_cast<std::ptrdiff_t>(position); };
        // Equal centres are ordered by number, so that the result does not depend on the library.
        std::nth_element(at(begin), at(middle), at(end), [&](uint32_t a, uint32_t b) {
            return std::pair(centres_[a][axis], a) < std::pair(centres_[b][axis], b);
        });
    }

    const Mesh& mesh_;
    std::span<uint32_t> order_;
    std::vector<Point> centres_;
};

} // namespace

KdTree KdTree::build(const Mesh& mesh, std::vector<uint32_t>& order, uint32_t maxLeafTriangles) {
    order.resize(mesh.triangles());
    std::iota(order.begin(), order.end(), 0u);
    Builder builder(mesh, order);
    builder.add(0, order.size(), static_cast<uint32_t>((order.size() + maxLeafTriangles - 1) / maxLeafTriangles));
    // Inside of a leaf, triangles keep the order of the mesh, which suits the caches of vertices.
    for (size_t leaf = 0, begin = 0; leaf < builder.leafEnds.size(); begin = builder.leafEnds[leaf++]) {
        std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
                  order.begin() + static_cast<std::ptrdiff_t>(builder.leafEnds[leaf]));
    }
    KdTree tree;
    tree.nodes_ = std::move(builder.nodes);
    tree.leafEnds_ = std::move(builder.leafEnds);
    return tree;
}

LeafRun KdTree::leavesOf(const Range& range) const {
    const uint64_t begin = countBefore(range.start, triangles());
    const uint64_t end = countBefore(range.end, triangles());
    const auto leafAt = [this](uint64_t triangle) {
        uint32_t leaf = 0;
        // The number of leaves whose middle precedes the triangle.
        for (uint32_t count = leaves(); count > 0;) {
            const uint32_t half = count / 2;
            const uint32_t probe = leaf + half;
            if ((firstTriangle(probe) + endTriangle(probe)) / 2 < triangle) {
                leaf = probe + 1;
                count -= half + 1;
            } else {
                count = half;
            }
        }
        return leaf;
    };
    return {leafAt(begin), leafAt(end)};
}

} // namespace mural::examples
