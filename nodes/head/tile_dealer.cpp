#include "nodes/head/tile_dealer.hpp"

#include <algorithm>
#include <utility>

#include "balancer/queue/random_areas.hpp"
#include "nodes/head/tile_split.hpp"

namespace mural {
namespace {

constexpr int kMostTiles = 16384;     // of a queue: what more would bring is less than what they cost here
constexpr size_t kMostFrames = 64;    // that some nodes have finished and others have not
constexpr int kOthers = 240;          // frames of other windows, of all nodes together, until a window counts as one that has ended

int piecesOf(int size, int step) { return (size + step - 1) / step; }

} // namespace

TileDealer::TileDealer(const SessionPlan& plan, Announce announce, const std::string& plant)
    : announce_(std::move(announce)), lives_(plan.nodes.size(), true), work_(plan.nodes.size(), 0) {
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
    const auto index = static_cast<size_t>(node);
    const std::lock_guard lock(mutex_);
    follow(message);
    work_[index] += static_cast<double>(message.busyNs);
    if (random_) dealAtRandom();
    if (Window{message.client, message.window} != followed_) return;
    for (Queue& queue : queues_)
        if (!queue.takers.empty() && node == queue.takers.front() && message.areas != std::exchange(queue.drawnBy, message.areas)) ++queue.totals.taken;
    if (random_) return;
    Frame& frame = frames_[message.frame];
    frame.times.resize(areas_.size(), -1);
    frame.areas.resize(areas_.size(), 0);
    frame.times[index] = std::exchange(work_[index], 0);
    frame.areas[index] = message.areas;
    bool complete = true, moved = false;
    for (size_t n = 0; n < lives_.size(); ++n) complete = complete && (!lives_[n] || frame.times[n] >= 0);
    if (complete) {
        for (Queue& queue : queues_) moved = compare(queue, frame) || moved;
        frames_.erase(frames_.begin(), frames_.upper_bound(message.frame));
    }
    if (frames_.size() > kMostFrames) frames_.erase(frames_.begin());
    if (moved) announce();
}

void TileDealer::answered() {
    if (!random_) return;
    const std::lock_guard lock(mutex_);
    if (width_ > 0) dealAtRandom();
}

// The largest window that has frames.
void TileDealer::follow(const wire::FrameDoneMessage& m) {
    const Window window{m.client, m.window};
    const auto width = static_cast<int>(m.width), height = static_cast<int>(m.height);
    if (width == 0 || height == 0) return;
    const bool larger = int64_t{width} * height > int64_t{width_} * height_;
    if (window == followed_) others_ = 0;
    else if (!larger && ++others_ <= kOthers) return;
    if (window == followed_ && width == width_ && height == height_) return;
    followed_ = window;
    others_ = 0;
    width_ = width;
    height_ = height;
    frames_.clear();
    for (Queue& queue : queues_) layOut(queue);
    announce();
}

PixelViewport TileDealer::pixelsOf(const Queue& queue) const { return apply({0, 0, width_, height_}, queue.plan.area); }

// Even parts for those that live; tiles are doubled until there are not too many.
void TileDealer::layOut(Queue& queue) {
    queue.takers.clear();
    for (const int node : queue.nodes)
        if (lives_[static_cast<size_t>(node)]) queue.takers.push_back(node);
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
bool TileDealer::compare(Queue& queue, const Frame& frame) {
    if (!queue.tiles) return false;
    std::vector<double> times;
    for (const int node : queue.takers) {
        const auto n = static_cast<size_t>(node);
        if (frame.areas[n] != number_) return false; // of other areas than those that were announced last
        times.push_back(frame.times[n]);
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
            areas_[static_cast<size_t>(queue.takers[i])] = relativeTo(PixelViewport{x0, y0, x(r.column + r.columns) - x0, y(r.row + r.rows) - y0}, PixelViewport{0, 0, width_, height_});
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
    if (client != followed_.first || (window != wire::kAllWindows && window != followed_.second)) return;
    frames_.clear();
    width_ = height_ = 0; // whatever has frames next is followed
    others_ = kOthers;
}

void TileDealer::nodeLost(int node) {
    const std::lock_guard lock(mutex_);
    lives_[static_cast<size_t>(node)] = false;
    if (!deals() || width_ == 0) return;
    frames_.clear();
    for (Queue& queue : queues_)
        if (std::ranges::find(queue.nodes, node) != queue.nodes.end()) layOut(queue);
    announce();
}

void TileDealer::nodeJoined(int node) {
    const std::lock_guard lock(mutex_);
    const bool lived = lives_[static_cast<size_t>(node)];
    lives_[static_cast<size_t>(node)] = true;
    if (lived || !deals() || width_ == 0) return;
    frames_.clear();
    work_[static_cast<size_t>(node)] = 0;
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
