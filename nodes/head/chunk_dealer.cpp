#include "nodes/head/chunk_dealer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "balancer/queue/random_areas.hpp"

namespace mural {
namespace {

constexpr int kMostChunks = 4096;

// Runs of chunks that n nodes have, about as many each.
std::vector<TileRegion> evenRuns(int chunks, int nodes) {
    std::vector<TileRegion> runs;
    for (int i = 0; i < nodes; ++i) {
        const int from = static_cast<int>(int64_t{chunks} * i / nodes), to = static_cast<int>(int64_t{chunks} * (i + 1) / nodes);
        runs.push_back({from, 0, to - from, 1});
    }
    return runs;
}

} // namespace

ChunkDealer::ChunkDealer(const SessionPlan& plan, Announce announce, const std::string& plant) : announce_(std::move(announce)), times_(plan.nodes.size()) {
    for (const NodePlan& node : plan.nodes) shares_.push_back(node.pass.share);
    for (size_t q = 0; q < plan.chunkQueues.size(); ++q) {
        Queue queue;
        queue.plan = plan.chunkQueues[q];
        for (const NodePlan& node : plan.nodes)
            if (node.chunkQueue == static_cast<int>(q)) queue.nodes.push_back(node.node);
        if (queue.nodes.size() < 2) continue;
        std::ranges::sort(queue.nodes, {}, [&](int node) { return plan.nodes[static_cast<size_t>(node)].pass.range; });
        queue.totals.name = queue.plan.name;
        queue.totals.chunks = true;
        queues_.push_back(std::move(queue));
    }
    for (Queue& queue : queues_) layOut(queue);
    if (plant == "shares" || plant == "lateshare") random_.emplace(20261123);
}

void ChunkDealer::frameDone(int node, const wire::FrameDoneMessage& message) {
    if (!deals()) return;
    const std::lock_guard lock(mutex_);
    times_.follow(message);
    times_.worked(node, message.busyNs);
    if (random_) dealAtRandom();
    if (!times_.follows(message)) return;
    for (Queue& queue : queues_)
        if (!queue.takers.empty() && node == queue.takers.front() && message.shares != std::exchange(queue.drawnBy, message.shares)) ++queue.totals.taken;
    if (random_) return;
    bool moved = false;
    if (const auto frame = times_.finished(node, message))
        for (Queue& queue : queues_) moved = compare(queue, *frame) || moved;
    if (moved) announce();
}

// As many chunks as the queue has, and one for each node at least.
void ChunkDealer::layOut(Queue& queue) {
    queue.takers.clear();
    for (const int node : queue.nodes)
        if (times_.lives(node)) queue.takers.push_back(node);
    queue.chunks.reset();
    const auto takers = static_cast<int>(queue.takers.size());
    if (takers > 0) {
        const int chunks = std::clamp(static_cast<int>(std::ceil(1 / std::max(queue.plan.part, 1.0 / kMostChunks) - 1e-9)), takers, kMostChunks);
        queue.chunks.emplace(chunks, 1, evenRuns(chunks, takers));
    }
    count(queue);
}

void ChunkDealer::layOutOf(int node) {
    bool any = false;
    for (Queue& queue : queues_) {
        if (std::ranges::find(queue.nodes, node) == queue.nodes.end()) continue;
        layOut(queue);
        any = true;
    }
    if (any) announce();
}

// True: chunks have moved. A frame of which nothing was shared says nothing.
bool ChunkDealer::compare(Queue& queue, const FrameTimes::Frame& frame) {
    if (!queue.chunks) return false;
    std::vector<double> times;
    for (const int node : queue.takers) {
        const auto n = static_cast<size_t>(node);
        if (frame.done[n].shares != number_ || (frame.done[n].flags & wire::kNotSplit)) return false;
        times.push_back(frame.busyNs[n]);
    }
    ++queue.totals.frames;
    const std::vector<TileRegion> before = queue.chunks->areas();
    if (!queue.chunks->drawn(times)) return false;
    ++queue.totals.moves;
    queue.totals.tilesMoved += queue::tilesMoved(before, queue.chunks->areas());
    return true;
}

void ChunkDealer::dealAtRandom() {
    for (Queue& queue : queues_) {
        if (!queue.chunks) continue;
        const int chunks = queue.chunks->columns();
        auto runs = queue::randomAreas(chunks, 1, queue.takers.size(), *random_);
        std::ranges::sort(runs, {}, &TileRegion::column);
        ++queue.totals.frames;
        ++queue.totals.moves;
        queue.totals.tilesMoved += queue::tilesMoved(queue.chunks->areas(), runs);
        queue.chunks.emplace(chunks, 1, std::move(runs));
    }
    announce();
}

// All queues' shares, to all nodes.
void ChunkDealer::announce() {
    for (Queue& queue : queues_) {
        count(queue);
        if (!queue.chunks) continue;
        const Range& whole = queue.plan.range;
        const int chunks = queue.chunks->columns();
        const auto edge = [&](int chunk) { return chunk == chunks ? whole.end : whole.start + (whole.end - whole.start) * chunk / chunks; };
        for (const int node : queue.nodes) shares_[static_cast<size_t>(node)] = {whole.start, whole.start};
        for (size_t i = 0; i < queue.takers.size(); ++i) {
            const TileRegion& run = queue.chunks->areas()[i];
            shares_[static_cast<size_t>(queue.takers[i])] = {edge(run.column), edge(run.column + run.columns)};
        }
    }
    announce_({++number_, shares_});
}

void ChunkDealer::windowGone(uint32_t client, uint32_t window) {
    const std::lock_guard lock(mutex_);
    times_.windowGone(client, window);
}

void ChunkDealer::nodeLost(int node) {
    const std::lock_guard lock(mutex_);
    times_.lost(node);
    layOutOf(node);
}

void ChunkDealer::nodeJoined(int node) {
    const std::lock_guard lock(mutex_);
    if (times_.joined(node)) layOutOf(node);
}

void ChunkDealer::count(Queue& queue) {
    queue.totals.nodes.clear();
    queue.totals.columns = queue.chunks ? queue.chunks->columns() : 0;
    queue.totals.rows = queue.chunks ? 1 : 0;
    for (const int node : queue.nodes) {
        const auto taker = std::ranges::find(queue.takers, node);
        const auto at = static_cast<size_t>(taker - queue.takers.begin());
        queue.totals.nodes.emplace_back(node, queue.chunks && taker != queue.takers.end() ? queue.chunks->areas()[at].columns : 0);
    }
}

std::vector<QueueTotals> ChunkDealer::totals() const {
    const std::lock_guard lock(mutex_);
    std::vector<QueueTotals> totals;
    for (const Queue& queue : queues_) totals.push_back(queue.totals);
    return totals;
}

} // namespace mural
