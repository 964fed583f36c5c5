#include "nodes/culling/draw_cut.hpp"

#include <algorithm>

namespace mural::culling {

namespace {

// Draws below this number of vertices are decided as a whole.
constexpr uint64_t kMinCutVertices = 512;
// A draw is drawn whole if more than this share of it stays: ranges would cost more than they save.
constexpr double kMaxKeptShare = 0.9;

class ClusterWalk {
public:
    ClusterWalk(const DrawBoxes& boxes, const TilePlanes& planes, uint64_t vertices, PrimitiveForm form,
                std::vector<VertexRange>& ranges)
        : boxes_(boxes), planes_(planes), vertices_(vertices), form_(form), ranges_(ranges) {}

    // Descends to clusters of level `lowest`. Returns false if there are too many ranges.
    bool walk(size_t lowest) {
        ranges_.clear();
        lowest_ = lowest;
        const size_t top = boxes_.levels().size() - 1;
        for (size_t cluster = 0; cluster < boxes_.clusters(top); ++cluster) visit(top, cluster);
        return ranges_.size() <= kMaxRanges;
    }

private:
    void visit(size_t level, size_t cluster) {
        if (ranges_.size() > kMaxRanges) return;
        const Place place = planes_.placeOf(boxes_.lowest(level, cluster), boxes_.highest(level, cluster));
        if (place == Place::Outside) return;
        if (place == Place::Inside || level <= lowest_) return keep(level, cluster);
        const size_t group = kClusterPrimitives[level] / kClusterPrimitives[level - 1];
        const size_t end = std::min((cluster + 1) * group, boxes_.clusters(level - 1));
        for (size_t part = cluster * group; part < end; ++part) visit(level - 1, part);
    }
    // Closes gaps of one cluster.
    void keep(size_t level, size_t cluster) {
        const uint64_t step = boxes_.levels()[level].vertices, gap = boxes_.levels()[lowest_].vertices;
        const uint64_t from = step * cluster, to = std::min(from + step + form_.overlap, vertices_);
        if (!ranges_.empty() && ranges_.back().first + ranges_.back().count + gap >= from)
            ranges_.back().count = to - ranges_.back().first;
        else
            ranges_.push_back({from, to - from});
    }

    const DrawBoxes& boxes_;
    const TilePlanes& planes_;
    const uint64_t vertices_;
    const PrimitiveForm form_;
    std::vector<VertexRange>& ranges_;
    size_t lowest_ = 0;
};

} // namespace

Cut cutDraw(const DrawBoxes& boxes, const TilePlanes& planes, uint64_t vertices, PrimitiveForm form, bool canCut,
            std::vector<VertexRange>& ranges) {
    if (boxes.inputs() != planes.inputs()) return Cut::Whole;
    const Place place = planes.placeOf(boxes.lowest(), boxes.highest());
    if (place == Place::Outside) return Cut::Nothing;
    if (place == Place::Inside || !canCut || boxes.levels().empty() || vertices < kMinCutVertices) return Cut::Whole;
    ClusterWalk walk(boxes, planes, vertices, form, ranges);
    bool fits = false;
    for (size_t lowest = 0; lowest < boxes.levels().size() && !fits; ++lowest) fits = walk.walk(lowest);
    if (!fits) return Cut::Whole;
    uint64_t kept = 0;
    for (const VertexRange& range : ranges) kept += range.count;
    if (ranges.empty()) return Cut::Nothing;
    return static_cast<double>(kept) > kMaxKeptShare * static_cast<double>(vertices) ? Cut::Whole : Cut::Ranges;
}

} // namespace mural::culling
