#include "nodes/head/balancing/chunk_equalizer.hpp"

#include "streamcodec/wire/node_messages.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mural {
namespace {

constexpr int kMaxChunks = 4096;

// Divides the chunks into n consecutive runs of nearly equal length.
std::vector<TileRegion> evenRuns(int chunks, int nodes) {
    std::vector<TileRegion> runs;
    for (int i = 0; i < nodes; ++i) {
        const int from = static_cast<int>(int64_t{chunks} * i / nodes),
                  to = static_cast<int>(int64_t{chunks} * (i + 1) / nodes);
        runs.push_back({from, 0, to - from, 1});
    }
    return runs;
}

} // namespace

ChunkEqualizer::ChunkEqualizer(const SessionPlan& plan, Announce announce, const std::string& plant)
    : announce_(std::move(announce)), times_(plan.nodes.size()) {
    for (const NodePlan& node : plan.nodes) shares_.push_back(node.pass.share);
    for (size_t q = 0; q < plan.chunkQueues.size(); ++q) {
        std::vector<int> nodes;
        for (const NodePlan& node : plan.nodes)
            if (node.chunkQueue == static_cast<int>(q)) nodes.push_back(node.node);
        if (nodes.size() < 2) continue;
        std::ranges::sort(nodes, {}, [&](int node) { return plan.nodes[static_cast<size_t>(node)].pass.range; });
        Queue& queue = queues_.emplace_back(Queue{plan.chunkQueues[q], WorkQueue(std::move(nodes))});
        queue.chunks.totals.name = queue.plan.name;
        queue.chunks.totals.chunks = true;
    }
    for (Queue& queue : queues_) layOut(queue);
    if (plant == "shares" || plant == "lateshare") random_.emplace(20261123);
}

void ChunkEqualizer::frameDone(int node, const wire::FrameDoneMessage& message) {
    if (!deals()) return;
    const std::lock_guard lock(mutex_);
    times_.follow(message);
    times_.worked(node, message.busyNs);
    if (random_) dealAtRandom();
    if (!times_.follows(message)) return;
    for (Queue& queue : queues_) queue.chunks.note(node, message.shares);
    if (random_) return;
    bool moved = false;
    if (const auto frame = times_.finished(node, message))
        for (Queue& queue : queues_)
            moved = queue.chunks.compare(*frame, &wire::FrameDoneMessage::shares, number_) || moved;
    if (moved) announce();
}

// Uses the queue's number of chunks, but at least one per node.
void ChunkEqualizer::layOut(Queue& queue) {
    queue.chunks.begin(times_);
    const auto takers = static_cast<int>(queue.chunks.takers().size());
    if (takers > 0) {
        const int chunks = std::clamp(
            static_cast<int>(std::ceil(1 / std::max(queue.plan.part, 1.0 / kMaxChunks) - 1e-9)), takers, kMaxChunks);
        queue.chunks.deal(chunks, 1, evenRuns(chunks, takers));
    }
    queue.chunks.count();
}

void ChunkEqualizer::layOutOf(int node) {
    bool any = false;
    for (Queue& queue : queues_) {
        if (!queue.chunks.has(node)) continue;
        layOut(queue);
        any = true;
    }
    if (any) announce();
}

void ChunkEqualizer::dealAtRandom() {
    for (Queue& queue : queues_) queue.chunks.dealAtRandom(*random_, true);
    announce();
}

// Sends the shares of all queues to all nodes.
void ChunkEqualizer::announce() {
    for (Queue& queue : queues_) {
        queue.chunks.count();
        if (!queue.chunks.deals()) continue;
        const Range& whole = queue.plan.range;
        const int chunks = queue.chunks.columns();
        const auto edge = [&](int chunk) {
            return chunk == chunks ? whole.end : whole.start + (whole.end - whole.start) * chunk / chunks;
        };
        for (const int node : queue.chunks.nodes()) shares_[static_cast<size_t>(node)] = {whole.start, whole.start};
        for (size_t i = 0; i < queue.chunks.takers().size(); ++i) {
            const TileRegion& run = queue.chunks.areas()[i];
            shares_[static_cast<size_t>(queue.chunks.takers()[i])] = {edge(run.column), edge(run.column + run.columns)};
        }
    }
    announce_({++number_, shares_});
}

void ChunkEqualizer::windowGone(uint32_t client, uint32_t window) {
    const std::lock_guard lock(mutex_);
    times_.windowGone(client, window);
}

void ChunkEqualizer::nodeLost(int node) {
    const std::lock_guard lock(mutex_);
    times_.lost(node);
    layOutOf(node);
}

void ChunkEqualizer::nodeJoined(int node) {
    const std::lock_guard lock(mutex_);
    if (times_.joined(node)) layOutOf(node);
}

std::vector<QueueTotals> ChunkEqualizer::totals() const {
    const std::lock_guard lock(mutex_);
    std::vector<QueueTotals> totals;
    for (const Queue& queue : queues_) totals.push_back(queue.chunks.totals);
    return totals;
}

} // namespace mural
