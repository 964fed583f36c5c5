#include "nodes/head/balancing/work_queue.hpp"

#include <algorithm>
#include <utility>

#include "balancer/equalizers/random_areas.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

bool WorkQueue::has(int node) const { return std::ranges::find(nodes_, node) != nodes_.end(); }

void WorkQueue::begin(const FrameTimes& times) {
    takers_.clear();
    for (const int node : nodes_)
        if (times.isAlive(node)) takers_.push_back(node);
    pieces_.reset();
}

void WorkQueue::dealAtRandom(std::mt19937& random, bool inOrder) {
    if (!pieces_) return;
    const int columns = pieces_->columns(), rows = pieces_->rows();
    auto areas = queue::randomAreas(columns, rows, takers_.size(), random);
    if (inOrder) std::ranges::sort(areas, {}, &TileRegion::column);
    ++totals.frames;
    ++totals.moves;
    totals.tilesMoved += queue::tilesMoved(pieces_->areas(), areas);
    deal(columns, rows, std::move(areas));
}

void WorkQueue::note(int node, uint32_t division) {
    if (!takers_.empty() && node == takers_.front() && division != std::exchange(drawnBy_, division)) ++totals.taken;
}

bool WorkQueue::compare(const FrameTimes::Frame& frame, Division division, uint32_t latest) {
    if (!pieces_) return false;
    std::vector<double> times;
    for (const int node : takers_) {
        const auto n = static_cast<size_t>(node);
        if (frame.done[n].*division != latest || (frame.done[n].flags & wire::kNotSplit)) return false;
        times.push_back(frame.busyNs[n]);
    }
    ++totals.frames;
    const std::vector<TileRegion> before = pieces_->areas();
    if (!pieces_->drawn(times)) return false;
    ++totals.moves;
    totals.tilesMoved += queue::tilesMoved(before, pieces_->areas());
    return true;
}

void WorkQueue::count() {
    totals.columns = pieces_ ? pieces_->columns() : 0;
    totals.rows = pieces_ ? pieces_->rows() : 0;
    totals.nodes.clear();
    for (const int node : nodes_) {
        const auto taker = std::ranges::find(takers_, node);
        const auto at = static_cast<size_t>(taker - takers_.begin());
        const bool has = pieces_ && taker != takers_.end();
        totals.nodes.emplace_back(node, has ? pieces_->areas()[at].columns * pieces_->areas()[at].rows : 0);
    }
}

} // namespace mural
