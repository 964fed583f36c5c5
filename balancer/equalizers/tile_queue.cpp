#include "balancer/equalizers/tile_queue.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mural::queue {

TileQueue::TileQueue(int columns, int rows, std::vector<TileRegion> areas, QueueRules rules)
    : rules_(rules), costs_(columns, rows), areas_(std::move(areas)), best_(areas_) {}

bool TileQueue::drawn(const std::vector<double>& times) {
    if (times.size() != areas_.size() || areas_.size() < 2 ||
        std::ranges::any_of(times, [](double t) { return !(t >= 0) || !std::isfinite(t); }))
        return false;
    if (frames_++ == 0) times_ = times;
    for (size_t i = 0; i < times.size(); ++i) times_[i] = (times_[i] + times[i]) / 2;
    if (frames_ < rules_.frames) return false;
    const double longest = *std::ranges::max_element(times_);
    return longest > 0 && rebalance(longest);
}

bool TileQueue::rebalance(double longest) {
    if (settled_) {
        if (std::abs(longest - bestLongest_) <= rules_.changed * bestLongest_) return false;
        settled_ = false;
        failures_ = 0;
        bestLongest_ = 0;
    }
    const bool isBetter = bestLongest_ == 0 || longest <= (1 - rules_.brought) * bestLongest_;
    const bool hasLoadChanged = !moved_ && longest > (1 + rules_.changed) * bestLongest_;
    if (isBetter || hasLoadChanged) {
        best_ = areas_;
        bestLongest_ = longest;
        failures_ = 0;
    } else if (moved_ && ++failures_ >= rules_.failures) {
        settled_ = true;
        return takeAreas(best_);
    }
    moved_ = false;
    for (size_t i = 0; i < areas_.size(); ++i) costs_.update(areas_[i], times_[i]);
    auto other = dealTiles(costs_, areas_);
    double promised = 0;
    for (const TileRegion& area : other) promised = std::max(promised, costs_.of(area));
    if (promised <= (1 - rules_.gain) * longest) return takeAreas(std::move(other));
    settled_ = longest > (1 + rules_.brought) * bestLongest_; // no better areas are reachable from here
    return settled_ && takeAreas(best_);
}

bool TileQueue::takeAreas(std::vector<TileRegion> areas) {
    frames_ = 0;
    if (areas == areas_) return false;
    areas_ = std::move(areas);
    moved_ = true;
    return true;
}

int tilesMoved(const std::vector<TileRegion>& a, const std::vector<TileRegion>& b) {
    int moved = 0;
    for (size_t i = 0; i < b.size(); ++i) {
        int stayed = 0;
        if (i < a.size()) {
            const int columns =
                std::min(a[i].column + a[i].columns, b[i].column + b[i].columns) - std::max(a[i].column, b[i].column);
            const int rows = std::min(a[i].row + a[i].rows, b[i].row + b[i].rows) - std::max(a[i].row, b[i].row);
            stayed = std::max(0, columns) * std::max(0, rows);
        }
        moved += b[i].columns * b[i].rows - stayed;
    }
    return moved;
}

} // namespace mural::queue
