// Binary division of an area or a range among the children of a compound: each inner node cuts its part in two. The
// first half of the children lies in the low part.
#pragma once

#include <span>

#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

using config::SplitMode;

enum class Axis : uint8_t { X, Y, Range };

struct SplitNode {
    size_t first = 0; // first child
    size_t count = 1;
    int low = -1; // nodes of the halves; -1: a leaf
    int high = -1;
    Axis axis = Axis::X;
    double at = .5; // position of the cut as a fraction of the node's part
    [[nodiscard]] bool isLeaf() const { return low < 0; }
};

struct Part {
    Viewport viewport;
    Range range;
    [[nodiscard]] bool empty() const { return viewport.empty() || range.empty(); }
    friend bool operator==(const Part&, const Part&) = default;
};

// Returns the low and the high half of a part. The edges of both are the same number.
std::pair<Part, Part> cutPart(const Part& part, Axis axis, double at);

[[nodiscard]] inline double extentOf(const Part& part, Axis axis) {
    return axis == Axis::X ? part.viewport.w : axis == Axis::Y ? part.viewport.h : part.range.end - part.range.start;
}

// Rules for positions of cuts. Lengths are fractions of the whole area or range.
struct CutRules {
    double boundaryX = 0, boundaryY = 0, boundaryRange = 0;       // grid and smallest extent of a child
    double resistanceX = 0, resistanceY = 0, resistanceRange = 0; // smaller moves are ignored
    std::vector<Viewport> largest;                                // per child: w and h; empty: no limit
    std::vector<double> usage;                                    // per child; 0: gets nothing

    [[nodiscard]] double boundary(Axis axis) const {
        return axis == Axis::X ? boundaryX : axis == Axis::Y ? boundaryY : boundaryRange;
    }
    [[nodiscard]] double resistance(Axis axis) const {
        return axis == Axis::X ? resistanceX : axis == Axis::Y ? resistanceY : resistanceRange;
    }
    [[nodiscard]] double usageOf(const SplitNode& node) const;
    [[nodiscard]] size_t usersOf(const SplitNode& node) const; // children with a usage
};

class SplitTree {
public:
    SplitTree() = default;
    // Even split. `aspect`: width of the area divided by its height. In mode 2D each node cuts the longer side of its
    // even part.
    SplitTree(size_t children, SplitMode mode, double aspect);

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] std::vector<SplitNode>& nodes() { return nodes_; }
    [[nodiscard]] const std::vector<SplitNode>& nodes() const { return nodes_; }
    [[nodiscard]] const SplitNode& low(const SplitNode& node) const { return nodes_[static_cast<size_t>(node.low)]; }
    [[nodiscard]] const SplitNode& high(const SplitNode& node) const { return nodes_[static_cast<size_t>(node.high)]; }

    // Moves the cut of a node with this part to `wanted` as far as the rules permit.
    void moveCut(SplitNode& node, const Part& part, double wanted, const CutRules& rules) const;
    // Moves each cut to the ratio of the resources on its sides.
    void divideByUsage(const CutRules& rules);
    // Returns the part of each child.
    [[nodiscard]] std::vector<Part> parts() const;

private:
    int build(size_t first, size_t count, SplitMode mode, double width, double height);
    void collect(int node, const Part& part, std::vector<Part>& parts) const;

    std::vector<SplitNode> nodes_; // root first
    bool alternates_ = false;      // cuts along both axes
};

// Sets the viewports, or ranges with SplitMode::Db, of the children. Children with an empty part become inactive.
// Returns true if something changed.
bool assignParts(std::span<const Index> children, SplitMode mode, const std::vector<Part>& parts, States& states);

} // namespace mural::balance
