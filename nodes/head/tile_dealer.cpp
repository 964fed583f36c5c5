#include "nodes/head/tile_dealer.hpp"

#include <algorithm>
#include <utility>

#include "balancer/queue/random_areas.hpp"
#include "nodes/head/tile_split.hpp"

namespace mural {
namespace {

constexpr int kMostTiles = 16384;     // of a queue: what more would bring is less than what they cost here

int piecesOf(int size, int step) { return (size + step - 1) / step; }

} // namespace

TileDealer::TileDealer(const SessionPlan& plan, Announce announce, const std::string& plant)
    : announce_(std::move(announce)), times_(plan.nodes.size()) {
    for (const NodePlan& node : plan.nodes) areas_.push_back(node.area.value_or(Viewport{}));
    for (size_t q = 0; q < plan.queues.size(); ++q) {
        Queue queue;
        queue.plan = plan.queues[q];
        for (const NodePlan& node : plan.nodes)
            if (node.queue == static_cast<int>(q)) queue.nodes.push_back(node.node);
        if (queue.nodes.size() > 1) queues_.push_back(std::move(queue));
    }
    for (Queue& queue : queues_) {
        queue.totals.name = queue.plan.name;
        queue.totals.width = queue.plan.width;
        queue.totals.height = queue.plan.height;
        countTiles(queue);
    }
    if (plant == "areas" || plant == "early" || plant == "uncleared") random_.emplace(20261123);
}

void TileDealer::frameDone(int node, const wire::FrameDoneMessage& message) {
    if (!deals()) return;
    const std::lock_guard lock(mutex_);
    if (times_.follow(message)) {
        for (Queue& queue : queues_) layOut(queue);
        announce();
    }
    times_.worked(node, message.busyNs);
    if (random_) dealAtRandom();
    if (!times_.follows(message)) return;
    for (Queue& queue : queues_)
        if (!queue.takers.empty() && node == queue.takers.front() && message.areas != std::exchange(queue.drawnBy, message.areas)) ++queue.totals.taken;
    if (random_) return;
    bool moved = false;
    if (const auto frame = times_.finished(node, message))
        for (Queue& queue : queues_) moved = compare(queue, *frame) || moved;
    if (moved) announce();
}

void TileDealer::answered() {
    if (!random_) return;
    const std::lock_guard lock(mutex_);
    if (times_.known()) dealAtRandom();
}

PixelViewport TileDealer::pixelsOf(const Queue& queue) const { return apply({0, 0, times_.width(), times_.height()}, queue.plan.area); }

// Even parts for those that live; tiles are doubled until there are not too many.
void TileDealer::layOut(Queue& queue) {
    queue.takers.clear();
    for (const int node : queue.nodes)
        if (times_.lives(node)) queue.takers.push_back(node);
    queue.tiles.reset();
    const PixelViewport pixels = pixelsOf(queue);
    int& w = queue.totals.width = std::max(1, queue.plan.width);
    int& h = queue.totals.height = std::max(1, queue.plan.height);
    if (pixels.empty() || queue.takers.empty()) return;
    while (int64_t{piecesOf(pixels.w, w)} * piecesOf(pixels.h, h) > kMostTiles) (w <= h ? w : h) *= 2;
    const auto takers = static_cast<int>(queue.takers.size());
    while (piecesOf(pixels.w, w) * piecesOf(pixels.h, h) < takers && (w > 1 || h > 1)) { // each takes one at least
        if (w > 1) w = (w + 1) / 2;
        if (h > 1) h = (h + 1) / 2;
    }
    const int columns = piecesOf(pixels.w, w), rows = piecesOf(pixels.h, h);
    if (columns * rows < takers) return; // a window of a few pixels: areas stay as they are
    queue.tiles.emplace(columns, rows, splitGrid(columns, rows, takers));
}

// True: tiles have moved.
bool TileDealer::compare(Queue& queue, const FrameTimes::Frame& frame) {
    if (!queue.tiles) return false;
    std::vector<double> times;
    for (const int node : queue.takers) {
        const auto n = static_cast<size_t>(node);
        if (frame.done[n].areas != number_) return false; // of other areas than those that were announced last
        times.push_back(frame.busyNs[n]);
    }
    ++queue.totals.frames;
    const std::vector<TileRegion> before = queue.tiles->areas();
    if (!queue.tiles->drawn(times)) return false;
    ++queue.totals.moves;
    queue.totals.tilesMoved += queue::tilesMoved(before, queue.tiles->areas());
    return true;
}

// All queues' areas, to all nodes.
void TileDealer::announce() {
    bool any = false;
    for (Queue& queue : queues_) {
        countTiles(queue);
        if (!queue.tiles) continue;
        any = true;
        const PixelViewport pixels = pixelsOf(queue);
        const auto x = [&](int column) { return pixels.x + std::min(pixels.w, column * queue.totals.width); };
        const auto y = [&](int row) { return pixels.y + std::min(pixels.h, row * queue.totals.height); };
        for (const int node : queue.nodes) areas_[static_cast<size_t>(node)] = {0, 0, 0, 0};
        for (size_t i = 0; i < queue.takers.size(); ++i) {
            const TileRegion& r = queue.tiles->areas()[i];
            const int x0 = x(r.column), y0 = y(r.row);
            areas_[static_cast<size_t>(queue.takers[i])] = relativeTo(PixelViewport{x0, y0, x(r.column + r.columns) - x0, y(r.row + r.rows) - y0}, PixelViewport{0, 0, times_.width(), times_.height()});
        }
    }
    if (any) announce_({++number_, areas_});
}

void TileDealer::dealAtRandom() {
    for (Queue& queue : queues_) {
        if (!queue.tiles) continue;
        const int columns = queue.tiles->columns(), rows = queue.tiles->rows();
        auto areas = queue::randomAreas(columns, rows, queue.takers.size(), *random_);
        ++queue.totals.frames;
        ++queue.totals.moves;
        queue.totals.tilesMoved += queue::tilesMoved(queue.tiles->areas(), areas);
        queue.tiles.emplace(columns, rows, std::move(areas));
    }
    announce();
}

void TileDealer::windowGone(uint32_t client, uint32_t window) {
    const std::lock_guard lock(mutex_);
    times_.windowGone(client, window);
}

void TileDealer::nodeLost(int node) {
    const std::lock_guard lock(mutex_);
    times_.lost(node);
    layOutOf(node);
}

void TileDealer::nodeJoined(int node) {
    const std::lock_guard lock(mutex_);
    if (times_.joined(node)) layOutOf(node);
}

void TileDealer::layOutOf(int node) {
    if (!deals() || !times_.known()) return;
    for (Queue& queue : queues_)
        if (std::ranges::find(queue.nodes, node) != queue.nodes.end()) layOut(queue);
    announce();
}

void TileDealer::countTiles(Queue& queue) const {
    queue.totals.nodes.clear();
    queue.totals.columns = queue.tiles ? queue.tiles->columns() : 0;
    queue.totals.rows = queue.tiles ? queue.tiles->rows() : 0;
    for (const int node : queue.nodes) {
        int tiles = 0;
        for (size_t i = 0; queue.tiles && i < queue.takers.size(); ++i)
            if (queue.takers[i] == node) tiles = queue.tiles->areas()[i].columns * queue.tiles->areas()[i].rows;
        queue.totals.nodes.emplace_back(node, tiles);
    }
}

std::vector<QueueTotals> TileDealer::totals() const {
    const std::lock_guard lock(mutex_);
    std::vector<QueueTotals> totals;
    for (const Queue& queue : queues_) totals.push_back(queue.totals);
    return totals;
}

} // namespace mural
