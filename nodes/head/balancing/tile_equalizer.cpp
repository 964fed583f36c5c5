#include "nodes/head/balancing/tile_equalizer.hpp"

#include <algorithm>
#include <utility>

#include "nodes/head/planning/tile_split.hpp"

namespace mural {
namespace {

constexpr int kMaxTiles = 16384; // per queue; more tiles cost more here than they gain

int piecesOf(int size, int step) { return (size + step - 1) / step; }

} // namespace

TileEqualizer::TileEqualizer(const SessionPlan& plan, Announce announce, const std::string& plant)
    : announce_(std::move(announce)), times_(plan.nodes.size()) {
    for (const NodePlan& node : plan.nodes) areas_.push_back(node.area.value_or(Viewport{}));
    for (size_t q = 0; q < plan.queues.size(); ++q) {
        std::vector<int> nodes;
        for (const NodePlan& node : plan.nodes)
            if (node.queue == static_cast<int>(q)) nodes.push_back(node.node);
        if (nodes.size() < 2) continue;
        Queue& queue = queues_.emplace_back(Queue{plan.queues[q], WorkQueue(std::move(nodes))});
        queue.tiles.totals.name = queue.plan.name;
        queue.tiles.totals.width = queue.plan.width;
        queue.tiles.totals.height = queue.plan.height;
        queue.tiles.count();
    }
    if (plant == "areas" || plant == "early" || plant == "uncleared") random_.emplace(20261123);
}

void TileEqualizer::frameDone(int node, const wire::FrameDoneMessage& message) {
    if (!deals()) return;
    const std::lock_guard lock(mutex_);
    if (times_.follow(message)) {
        for (Queue& queue : queues_) layOut(queue);
        announce();
    }
    times_.worked(node, message.busyNs);
    if (random_) dealAtRandom();
    if (!times_.follows(message)) return;
    for (Queue& queue : queues_) queue.tiles.note(node, message.areas);
    if (random_) return;
    bool moved = false;
    if (const auto frame = times_.finished(node, message))
        for (Queue& queue : queues_)
            moved = queue.tiles.compare(*frame, &wire::FrameDoneMessage::areas, number_) || moved;
    if (moved) announce();
}

void TileEqualizer::answered() {
    if (!random_) return;
    const std::lock_guard lock(mutex_);
    if (times_.known()) dealAtRandom();
}

PixelViewport TileEqualizer::pixelsOf(const Queue& queue) const {
    return apply({0, 0, times_.width(), times_.height()}, queue.plan.area);
}

// Starts with equal parts for the living nodes. Doubles the tile size while there are too many tiles.
void TileEqualizer::layOut(Queue& queue) {
    queue.tiles.begin(times_);
    const PixelViewport pixels = pixelsOf(queue);
    int& w = queue.tiles.totals.width = std::max(1, queue.plan.width);
    int& h = queue.tiles.totals.height = std::max(1, queue.plan.height);
    if (pixels.empty() || queue.tiles.takers().empty()) return;
    while (int64_t{piecesOf(pixels.w, w)} * piecesOf(pixels.h, h) > kMaxTiles) (w <= h ? w : h) *= 2;
    const auto takers = static_cast<int>(queue.tiles.takers().size());
    // each node gets at least one tile
    while (piecesOf(pixels.w, w) * piecesOf(pixels.h, h) < takers && (w > 1 || h > 1)) {
        if (w > 1) w = (w + 1) / 2;
        if (h > 1) h = (h + 1) / 2;
    }
    const int columns = piecesOf(pixels.w, w), rows = piecesOf(pixels.h, h);
    if (columns * rows < takers) return; // a window of a few pixels: areas stay fixed
    queue.tiles.deal(columns, rows, splitGrid(columns, rows, takers));
}

// Sends the areas of all queues to all nodes.
void TileEqualizer::announce() {
    bool any = false;
    for (Queue& queue : queues_) {
        queue.tiles.count();
        if (!queue.tiles.deals()) continue;
        any = true;
        const PixelViewport pixels = pixelsOf(queue);
        const auto x = [&](int column) { return pixels.x + std::min(pixels.w, column * queue.tiles.totals.width); };
        const auto y = [&](int row) { return pixels.y + std::min(pixels.h, row * queue.tiles.totals.height); };
        for (const int node : queue.tiles.nodes()) areas_[static_cast<size_t>(node)] = {0, 0, 0, 0};
        for (size_t i = 0; i < queue.tiles.takers().size(); ++i) {
            const TileRegion& r = queue.tiles.areas()[i];
            const int x0 = x(r.column), y0 = y(r.row);
            areas_[static_cast<size_t>(queue.tiles.takers()[i])] =
                relativeTo(PixelViewport{x0, y0, x(r.column + r.columns) - x0, y(r.row + r.rows) - y0},
                           PixelViewport{0, 0, times_.width(), times_.height()});
        }
    }
    if (any) announce_({++number_, areas_});
}

void TileEqualizer::dealAtRandom() {
    for (Queue& queue : queues_) queue.tiles.dealAtRandom(*random_, false);
    announce();
}

void TileEqualizer::windowGone(uint32_t client, uint32_t window) {
    const std::lock_guard lock(mutex_);
    times_.windowGone(client, window);
}

void TileEqualizer::nodeLost(int node) {
    const std::lock_guard lock(mutex_);
    times_.lost(node);
    layOutOf(node);
}

void TileEqualizer::nodeJoined(int node) {
    const std::lock_guard lock(mutex_);
    if (times_.joined(node)) layOutOf(node);
}

void TileEqualizer::layOutOf(int node) {
    if (!deals() || !times_.known()) return;
    for (Queue& queue : queues_)
        if (queue.tiles.has(node)) layOut(queue);
    announce();
}

std::vector<QueueTotals> TileEqualizer::totals() const {
    const std::lock_guard lock(mutex_);
    std::vector<QueueTotals> totals;
    for (const Queue& queue : queues_) totals.push_back(queue.tiles.totals);
    return totals;
}

} // namespace mural
