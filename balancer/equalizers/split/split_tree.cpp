#include "balancer/equalizers/split/split_tree.hpp"

#include <cmath>

namespace mural::balance {

namespace {

constexpr Viewport kNoArea{0, 0, 0, 0};
constexpr Range kNoRange{0, 0};

// Largest number of children side by side along an axis if cuts alternate.
size_t besides(size_t children, bool alternates) {
    if (!alternates) return children;
    size_t columns = 1, rows = 1;
    while (columns * rows < children) (columns <= rows ? columns : rows) *= 2;
    return columns;
}

} // namespace

std::pair<Part, Part> cutPart(const Part& part, Axis axis, double at) {
    Part low = part, high = part;
    switch (axis) {
    case Axis::X:
        low.viewport.w = at >= 1 ? part.viewport.w : part.viewport.w * at;
        high.viewport.x = part.viewport.x + low.viewport.w;
        high.viewport.w = at >= 1 ? 0 : part.viewport.w - low.viewport.w;
        break;
    case Axis::Y:
        low.viewport.h = at >= 1 ? part.viewport.h : part.viewport.h * at;
        high.viewport.y = part.viewport.y + low.viewport.h;
        high.viewport.h = at >= 1 ? 0 : part.viewport.h - low.viewport.h;
        break;
    case Axis::Range:
        low.range.end = high.range.start =
            at >= 1 ? part.range.end : part.range.start + (part.range.end - part.range.start) * at;
        break;
    }
    return {low, high};
}

double CutRules::usageOf(const SplitNode& node) const {
    double sum = 0;
    for (size_t i = node.first; i < node.first + node.count; ++i) sum += usage[i];
    return sum;
}

size_t CutRules::usersOf(const SplitNode& node) const {
    size_t users = 0;
    for (size_t i = node.first; i < node.first + node.count; ++i) users += usage[i] > 0 ? 1 : 0;
    return users;
}

SplitTree::SplitTree(size_t children, SplitMode mode, double aspect) : alternates_(mode == SplitMode::TwoD) {
    if (children > 0) build(0, children, mode, aspect, 1);
}

int SplitTree::build(size_t first, size_t count, SplitMode mode, double width, double height) {
    const auto index = static_cast<int>(nodes_.size());
    nodes_.push_back({first, count});
    if (count < 2) return index;
    Axis axis = width >= height ? Axis::X : Axis::Y;
    if (mode == SplitMode::Vertical) axis = Axis::X;
    if (mode == SplitMode::Horizontal) axis = Axis::Y;
    if (mode == SplitMode::Db) axis = Axis::Range;
    const size_t half = count / 2;
    const double at = static_cast<double>(half) / static_cast<double>(count);
    const bool x = axis == Axis::X, y = axis == Axis::Y;
    const int low = build(first, half, mode, x ? width * at : width, y ? height * at : height);
    const int high =
        build(first + half, count - half, mode, x ? width * (1 - at) : width, y ? height * (1 - at) : height);
    SplitNode& node = nodes_[static_cast<size_t>(index)];
    node.low = low;
    node.high = high;
    node.axis = axis;
    node.at = at;
    return index;
}

void SplitTree::moveCut(SplitNode& node, const Part& part, double wanted, const CutRules& rules) const {
    const double extent = extentOf(part, node.axis);
    const size_t users[2] = {rules.usersOf(low(node)), rules.usersOf(high(node))};
    if (users[0] == 0 || users[1] == 0 || !(extent > 0)) {
        node.at = users[0] == 0 && users[1] > 0 ? 0 : users[1] == 0 ? 1 : node.at;
        return;
    }
    const size_t counts[2] = {besides(users[0], alternates_), besides(users[1], alternates_)};
    const double boundary = rules.boundary(node.axis);
    double least = boundary * static_cast<double>(counts[0]);
    double most = extent - boundary * static_cast<double>(counts[1]);
    if (!rules.largest.empty() && node.axis != Axis::Range) {
        const auto largest = [&](const SplitNode& half, size_t count) {
            double size = 0;
            for (size_t i = half.first; i < half.first + half.count; ++i)
                size = std::max(size, node.axis == Axis::X ? rules.largest[i].w : rules.largest[i].h);
            return size * static_cast<double>(count);
        };
        most = std::min(most, largest(low(node), counts[0]));
        least = std::max(least, extent - largest(high(node), counts[1]));
    }
    if (least > most) { // too little room: in proportion to the children
        node.at = static_cast<double>(users[0]) / static_cast<double>(users[0] + users[1]);
        return;
    }
    const double start = node.axis == Axis::X   ? part.viewport.x
                         : node.axis == Axis::Y ? part.viewport.y
                                                : part.range.start;
    double cut = std::clamp(std::isfinite(wanted) ? wanted : .5, 0., 1.) * extent;
    if (boundary > 0) cut = std::round((start + cut) / boundary) * boundary - start;
    cut = std::clamp(cut, least, most);
    const double before = node.at * extent;
    if (std::abs(cut - before) < rules.resistance(node.axis) && before >= least && before <= most) return;
    node.at = cut / extent;
}

void SplitTree::divideByUsage(const CutRules& rules) {
    for (SplitNode& node : nodes_) {
        if (node.isLeaf()) continue;
        const double below = rules.usageOf(low(node)), above = rules.usageOf(high(node));
        if (below + above > 0) node.at = below / (below + above);
    }
}

void SplitTree::collect(int index, const Part& part, std::vector<Part>& parts) const {
    const SplitNode& node = nodes_[static_cast<size_t>(index)];
    if (node.isLeaf()) {
        parts[node.first] = part;
        return;
    }
    const auto [low, high] = cutPart(part, node.axis, node.at);
    collect(node.low, low, parts);
    collect(node.high, high, parts);
}

std::vector<Part> SplitTree::parts() const {
    std::vector<Part> parts;
    if (nodes_.empty()) return parts;
    parts.resize(nodes_.front().count);
    collect(0, {}, parts);
    return parts;
}

bool assignParts(std::span<const Index> children, SplitMode mode, const std::vector<Part>& parts, States& states) {
    bool changed = false;
    for (size_t i = 0; i < children.size(); ++i) {
        CompoundState& state = states[at(children[i])];
        const bool isActive = !parts[i].empty();
        if (mode == SplitMode::Db) {
            const Range range = isActive ? parts[i].range : kNoRange;
            changed |= state.range != range || state.active != isActive;
            state.range = range;
        } else {
            const Viewport viewport = isActive ? parts[i].viewport : kNoArea;
            changed |= state.viewport != viewport || state.active != isActive;
            state.viewport = viewport;
        }
        state.active = isActive;
    }
    return changed;
}

} // namespace mural::balance
