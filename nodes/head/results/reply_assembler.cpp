#include "nodes/head/results/reply_assembler.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace mural {
namespace {

using wire::ReplyKind;
using wire::ReplyPartHeader;

constexpr size_t kMaxOpenRequests = 65536;
constexpr int64_t kMaxReplyBytes = int64_t{1} << 30;
constexpr size_t kMaxParts = 65536; // per request

Error contradiction(const ReplyPartHeader& header) {
    return Error{"its reply to request " + std::to_string(header.requestId) +
                 " contradicts the other nodes' replies; install the same version of mural on all machines"};
}

} // namespace

ReplyAssembler::ReplyAssembler(int nodes, Deliver deliver)
    : deliver_(std::move(deliver)), views_(static_cast<size_t>(nodes)) {}

Result<void> ReplyAssembler::answer(int node, const ReplyPartHeader& header, ByteBuffer bytes) {
    Request complete;
    {
        const std::lock_guard lock(mutex_);
        if (!views_.isAlive(node)) return {};
        if (requests_.size() >= kMaxOpenRequests) return Error{"it sent too many replies without a request"};
        const Key key{header.client, header.requestId};
        Request& request = requests_[key];
        if (auto added = add(node, header, std::move(bytes), request); !added) return added;
        const bool deliver = !request.delivered && canDeliver(request);
        if (deliver) {
            // Later replies to the request are recognised, and discarded.
            complete = std::exchange(
                request,
                Request{request.kind, request.groupBytes, {}, request.awaited, request.last, request.firstNode, true});
        }
        if (allAnswered(request)) requests_.erase(key);
        if (!deliver) return {};
    }
    deliver_(header.client, assemble(header.requestId, complete));
    return {};
}

Result<void> ReplyAssembler::add(int node, const ReplyPartHeader& header, ByteBuffer bytes, Request& r) {
    if (header.kind < 1 || header.kind > 3) return Error{"it sent a reply of unknown kind"};
    if (r.last.empty()) {
        r.awaited = views_.awaited(node);
        r.last.resize(r.awaited.size(), false);
        r.kind = header.kind;
        r.groupBytes = header.groupBytes;
    }
    const auto index = static_cast<size_t>(node);
    if (index >= r.awaited.size() || !r.awaited[index]) return {};
    if (r.kind != header.kind || r.last[index]) return contradiction(header);
    r.last[index] = header.last != 0;
    if (r.delivered || (bytes.size() == 0 && header.first == 0)) return {};
    const bool rectangle = r.kind == static_cast<uint32_t>(ReplyKind::Rectangle);
    PixelViewport where;
    if (rectangle) {
        where = {header.x, header.y, header.w, header.h};
        PixelViewport all = where;
        for (const Part& part : r.parts) all = unite(all, part.rectangle);
        // The limit of 64 that NodeConnection enforces rules out an overflow here.
        if (header.groupBytes != r.groupBytes || all.area() * header.groupBytes > kMaxReplyBytes)
            return contradiction(header);
    }
    if (header.first != 0 && (r.firstNode < 0 || node < r.firstNode)) r.firstNode = node;
    if (r.parts.size() >= kMaxParts) return Error{"its reply has too many parts"};
    r.parts.push_back({node, where, std::move(bytes)});
    return {};
}

bool ReplyAssembler::allAnswered(const Request& request) const {
    for (size_t node = 0; node < request.awaited.size(); ++node)
        if (request.awaited[node] && !request.last[node]) return false;
    return true;
}

bool ReplyAssembler::canDeliver(const Request& request) const {
    const bool bytes = request.kind == static_cast<uint32_t>(ReplyKind::Bytes);
    // A rectangle that lies in one node's part needs no replies of other nodes.
    const bool rectangle = request.kind == static_cast<uint32_t>(ReplyKind::Rectangle);
    if (rectangle && request.firstNode >= 0 && request.last[static_cast<size_t>(request.firstNode)]) return true;
    // All nodes hold the same bytes, except undefined ones. The answer of the first living node is always used, so that
    // two reads agree.
    const auto speaker = static_cast<int>(std::ranges::find(request.awaited, true) - request.awaited.begin());
    if (bytes && request.firstNode == speaker && request.last[static_cast<size_t>(speaker)]) return true;
    return allAnswered(request);
}

void ReplyAssembler::nodeLost(int node) {
    std::vector<std::pair<Key, Request>> complete;
    {
        const std::lock_guard lock(mutex_);
        views_.lost(node);
        for (auto it = requests_.begin(); it != requests_.end();) {
            Request& request = it->second;
            if (static_cast<size_t>(node) >= request.awaited.size()) { // it came later
                ++it;
                continue;
            }
            request.awaited[static_cast<size_t>(node)] = false;
            // Discards a partial reply of kind Bytes: another node sends all bytes.
            if (request.firstNode == node && !request.last[static_cast<size_t>(node)]) request.firstNode = -1;
            if (!allAnswered(request)) {
                ++it;
                continue;
            }
            if (!request.delivered) complete.emplace_back(it->first, std::move(request));
            it = requests_.erase(it);
        }
    }
    for (auto& [key, request] : complete) deliver_(key.first, assemble(key.second, request));
}

void ReplyAssembler::addNodes(size_t count) {
    const std::lock_guard lock(mutex_);
    views_.addNodes(count);
}

void ReplyAssembler::nodeJoins(int node, uint32_t view) {
    const std::lock_guard lock(mutex_);
    views_.joins(node, view);
}

void ReplyAssembler::nodeInView(int node, uint32_t view) {
    const std::lock_guard lock(mutex_);
    views_.reached(node, view);
}

size_t ReplyAssembler::openRequests() const {
    const std::lock_guard lock(mutex_);
    return requests_.size();
}

std::vector<int> ReplyAssembler::missing(uint32_t client) const {
    const std::lock_guard lock(mutex_);
    std::vector<int> nodes;
    const auto oldest = requests_.lower_bound({client, 0});
    const bool known = oldest != requests_.end() && oldest->first.first == client;
    for (size_t node = 0; node < (known ? oldest->second.awaited.size() : views_.size()); ++node) {
        const bool isAwaited =
            known ? oldest->second.awaited[node] && !oldest->second.last[node] : views_.isAlive(static_cast<int>(node));
        if (isAwaited) nodes.push_back(static_cast<int>(node));
    }
    return nodes;
}

Reply ReplyAssembler::assemble(uint32_t requestId, const Request& request) {
    Reply reply;
    reply.header.requestId = requestId;
    reply.header.kind = request.kind;
    reply.header.failed = 1; // set to 0 by the first valid reply
    if (request.kind == static_cast<uint32_t>(ReplyKind::Rectangle)) assembleRectangle(request, reply);
    if (request.kind == static_cast<uint32_t>(ReplyKind::Bytes)) assembleBytes(request, reply);
    if (request.kind == static_cast<uint32_t>(ReplyKind::Sum)) assembleSum(request, reply);
    reply.header.sizeBytes = reply.bytes.size();
    return reply;
}

void ReplyAssembler::assembleRectangle(const Request& request, Reply& reply) {
    PixelViewport all;
    int64_t covered = 0;
    for (const Part& part : request.parts) {
        all = unite(all, part.rectangle);
        covered += part.rectangle.area();
    }
    // A rectangle outside all tiles has a valid reply without pixels.
    reply.header.failed = std::ranges::find(request.last, true) == request.last.end() && all.empty();
    reply.header.groupBytes = request.groupBytes;
    reply.header.x = all.x;
    reply.header.y = all.y;
    reply.header.w = all.w;
    reply.header.h = all.h;
    const size_t pixelBytes = request.groupBytes;
    const size_t rowBytes = static_cast<size_t>(all.w) * pixelBytes;
    reply.bytes = ByteBuffer::ofSize(rowBytes * static_cast<size_t>(all.h));
    if (reply.bytes.size() == 0) {
        reply.header.w = reply.header.h = 0;
        return;
    }
    if (covered < all.area()) std::memset(reply.bytes.data(), 0, reply.bytes.size());
    for (const Part& part : request.parts) {
        const size_t partRowBytes = static_cast<size_t>(part.rectangle.w) * pixelBytes;
        const auto left = static_cast<size_t>(part.rectangle.x - all.x) * pixelBytes;
        const auto bottom = static_cast<size_t>(part.rectangle.y - all.y);
        for (size_t y = 0; y < static_cast<size_t>(part.rectangle.h); ++y) {
            std::memcpy(reply.bytes.data() + (bottom + y) * rowBytes + left, part.bytes.data() + y * partRowBytes,
                        partRowBytes);
        }
    }
}

void ReplyAssembler::assembleBytes(const Request& request, Reply& reply) {
    int from = request.firstNode;
    for (const Part& part : request.parts) {
        // If the preferred node is lost, the first node with a complete reply replaces it.
        const bool whole = request.last[static_cast<size_t>(part.node)];
        if (request.firstNode < 0 && whole && (from < 0 || part.node < from)) from = part.node;
    }
    size_t sizeBytes = 0;
    for (const Part& part : request.parts)
        if (part.node == from) sizeBytes += part.bytes.size();
    reply.bytes = ByteBuffer::ofSize(sizeBytes);
    reply.header.failed = from < 0 || reply.bytes.size() != sizeBytes;
    if (reply.header.failed != 0) return;
    size_t at = 0;
    for (const Part& part : request.parts) {
        if (part.node != from || part.bytes.size() == 0) continue;
        std::memcpy(reply.bytes.data() + at, part.bytes.data(), part.bytes.size());
        at += part.bytes.size();
    }
}

void ReplyAssembler::assembleSum(const Request& request, Reply& reply) {
    std::vector<uint64_t> sums;
    for (const Part& part : request.parts) {
        const size_t count = part.bytes.size() / sizeof(uint64_t);
        if (sums.size() < count) sums.resize(count, 0);
        for (size_t i = 0; i < count; ++i) {
            uint64_t value = 0;
            std::memcpy(&value, part.bytes.data() + i * sizeof(value), sizeof(value));
            sums[i] += value;
        }
    }
    if (sums.empty()) return;
    reply.header.failed = 0;
    reply.bytes = ByteBuffer::ofSize(sums.size() * sizeof(uint64_t));
    if (reply.bytes.size() != 0) std::memcpy(reply.bytes.data(), sums.data(), reply.bytes.size());
}

} // namespace mural
