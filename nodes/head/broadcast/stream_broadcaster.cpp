#include "nodes/head/broadcast/stream_broadcaster.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>

#include "nodes/head/broadcast/bytes_of.hpp"
#include "nodes/head/broadcast/head_command.hpp"
#include "nodes/frame_spans/span_scope.hpp"
#include "streamcodec/delta/batch_head.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {

void StreamBroadcaster::add(std::unique_ptr<NodeConnection> link) {
    links_.add(link.get());
    owned_.push_back(std::move(link));
}

void StreamBroadcaster::setDeltaStream(std::unique_ptr<DeltaStream> deltaStream) {
    deltaStream_ = std::move(deltaStream);
    deltaStream_->sendBy([this] {
        sendBatchLocked();
        flushLinksLocked();
    });
}

void StreamBroadcaster::startReading() {
    for (NodeConnection* link : links_) link->startReading();
}

Result<RejoinLog::Snapshot> StreamBroadcaster::beginRecording(trace::StreamRecorder& recorder,
                                                              const std::function<void()>& atPosition,
                                                              Deadline deadline) {
    uint64_t position = 0;
    {
        ++joining_;
        const std::unique_lock lock(sendMutex_, std::chrono::nanoseconds(deadline.leftNs(60 * kNsPerS)));
        --joining_;
        if (!lock.owns_lock()) return Error{"a node accepts no data at the moment; see mural stat, and try again"};
        position = rejoinLog_->pause();
        recorder_ = &recorder;
        atPosition();
    }
    return rejoinLog_->snapshot(position, deadline);
}

bool StreamBroadcaster::endRecording(Deadline deadline) {
    ++joining_;
    const std::unique_lock lock(sendMutex_, std::chrono::nanoseconds(deadline.leftNs(60 * kNsPerS)));
    --joining_;
    if (lock.owns_lock()) recorder_ = nullptr;
    return lock.owns_lock();
}

bool StreamBroadcaster::broadcast(uint32_t stream, std::span<const std::byte> payload) {
    if (joining_ > 0) std::this_thread::yield(); // the mutex is not fair: lets the joining thread go first
    const std::lock_guard lock(sendMutex_);
    if (hasLead_.load(std::memory_order_relaxed) && wire::clientOf(stream) != 0) sendLeadLocked();
    if (recorder_) recorder_->packet(stream, payload);
    keepLocked(stream, payload);
    return sendLocked(stream, payload);
}

bool StreamBroadcaster::broadcast(wire::HeadCommand command, std::span<const std::byte> arguments) {
    const bool sent = broadcast(wire::streamOf(0, 0), commandBytes(command, arguments));
    flush();
    return sent;
}

// A link with batches marks the packet by the head of an empty batch, which no encoder writes.
void StreamBroadcaster::sendToNode(uint32_t node, uint32_t stream, std::span<const std::byte> payload) {
    if (joining_ > 0) std::this_thread::yield();
    const std::lock_guard lock(sendMutex_);
    if (node >= links_.size()) return;
    NodeConnection& to = *links_[node].load();
    const wire::PacketHeader header{static_cast<uint32_t>(payload.size()), stream};
    std::vector<std::byte> head;
    if (to.inBatches() && !to.byMulticast()) delta::putBatchHead({}, head);
    const auto bytes = bytesOf(header);
    head.insert(head.end(), bytes.begin(), bytes.end());
    const SpanScope sends(SpanKind::Send);
    sendTo(to, head, payload);
    sendingTo_ = kNobody;
}

void StreamBroadcaster::scheduleBeforeNextPacket(wire::HeadCommand command, std::span<const std::byte> arguments) {
    const std::lock_guard lock(leadMutex_);
    leads_[command] = commandBytes(command, arguments);
    hasLead_ = true;
}

void StreamBroadcaster::scheduleSoon(wire::HeadCommand command, std::span<const std::byte> arguments) {
    scheduleBeforeNextPacket(command, arguments);
    isLeadUrgent_ = true;
}

void StreamBroadcaster::sendScheduled() {
    if (!isLeadUrgent_.load(std::memory_order_relaxed)) return;
    const std::lock_guard lock(sendMutex_);
    sendLeadLocked();
    flushLocked();
}

void StreamBroadcaster::sendLeadLocked() {
    std::map<wire::HeadCommand, std::vector<std::byte>> leads;
    {
        const std::lock_guard lock(leadMutex_);
        leads.swap(leads_);
        hasLead_ = false;
        isLeadUrgent_ = false;
    }
    for (auto& [command, bytes] : leads) {
        if (command == wire::HeadCommand::ClockProbe) bytes = commandBytes(command, bytesOf(monotonicNowNs()));
        sendLocked(wire::streamOf(0, 0), bytes);
    }
}

bool StreamBroadcaster::broadcast(wire::HeadCommand command, Deadline deadline) {
    std::unique_lock lock(sendMutex_, std::chrono::nanoseconds(deadline.leftNs(60 * kNsPerS)));
    if (!lock.owns_lock()) return false;
    const bool sent = sendLocked(wire::streamOf(0, 0), commandBytes(command, {}));
    flushLocked();
    return sent;
}

bool StreamBroadcaster::sendLocked(uint32_t stream, std::span<const std::byte> payload) {
    const bool plain = sendPacketLocked(stream, payload);
    if (!deltaStream_) return plain;
    const bool batched =
        std::ranges::any_of(links_, [](const NodeConnection* link) { return link->inBatches() && link->alive(); });
    if (!batched) {
        deltaStream_->miss(stream, payload); // its state must still follow the programs
        return plain;
    }
    deltaStream_->add(stream, payload);
    return true;
}

bool StreamBroadcaster::sendPacketLocked(uint32_t stream, std::span<const std::byte> payload) {
    const wire::PacketHeader header{static_cast<uint32_t>(payload.size()), stream};
    return sendToLinksLocked(bytesOf(header), payload, false);
}

// Sends to the links that receive batches, or to all others.
bool StreamBroadcaster::sendToLinksLocked(std::span<const std::byte> header, std::span<const std::byte> payload,
                                          bool inBatches) {
    const SpanScope sends(SpanKind::Send);
    bool any = false;
    bool byMulticast = false;
    for (NodeConnection* link : links_) {
        if (link->inBatches() != inBatches) continue;
        if (link->byMulticast())
            byMulticast = byMulticast || (link->member() && link->alive()); // others have left
        else
            sendTo(*link, header, payload);
        byMulticast = byMulticast || link == changingOver_;
        any = any || link->alive();
    }
    if (byMulticast) multicastLocked(header, payload);
    sendingTo_ = kNobody;
    if (inBatches || !deltaStream_) bytesSent_.fetch_add(header.size() + payload.size(), std::memory_order_relaxed);
    return any;
}

void StreamBroadcaster::sendBatchLocked() {
    if (!deltaStream_ || deltaStream_->empty()) return;
    auto batch = deltaStream_->take();
    if (!batch) {
        for (NodeConnection* link : links_)
            if (link->inBatches()) link->lose(batch.error().message);
        return;
    }
    const int64_t beganNs = monotonicNowNs();
    sendToLinksLocked(batch.value(), {}, true);
    deltaStream_->wrote(batch->size(), monotonicNowNs() - beganNs);
}

void StreamBroadcaster::sendTo(NodeConnection& link, std::span<const std::byte> header,
                               std::span<const std::byte> payload) {
    sendingTo_ = link.location().node;
    link.send(header, payload);
}

std::vector<int> StreamBroadcaster::full() const {
    const int to = sendingTo_;
    if (to == kMulticast) return multicast_->waitsFor();
    return to == kNobody ? std::vector<int>() : std::vector<int>{to};
}

void StreamBroadcaster::multicastLocked(std::span<const std::byte> header, std::span<const std::byte> payload) {
    constexpr int64_t kWriteLimitMs = 600'000; // a last resort: watch() loses silent nodes earlier
    const Deadline deadline = Deadline::inMs(kWriteLimitMs);
    sendingTo_ = kMulticast;
    Result<void> written = multicast_->write(header, deadline);
    if (written && !payload.empty()) written = multicast_->write(payload, deadline);
    if (written) return;
    for (NodeConnection* link : links_)
        if (link->byMulticast()) link->lose("the multicast group failed: " + written.error().message);
}

void StreamBroadcaster::flushLocked() {
    sendBatchLocked();
    flushLinksLocked();
}

void StreamBroadcaster::flushLinksLocked() {
    for (NodeConnection* link : links_) link->flush(); // packets to one node use its connection also beside multicast
    if (multicast_) multicast_->flush();
}

void StreamBroadcaster::sendAlone(int node, wire::HeadCommand command, const std::string& json) {
    const auto payload = commandBytes(command, std::as_bytes(std::span(json.data(), json.size())));
    const wire::PacketHeader header{static_cast<uint32_t>(payload.size()), wire::streamOf(0, 0)};
    link(node).sendNow(bytesOf(header), payload);
    link(node).flushNow();
}

void StreamBroadcaster::flush() {
    const std::lock_guard lock(sendMutex_);
    flushLocked();
}

bool StreamBroadcaster::flushActionable() {
    const std::lock_guard lock(sendMutex_);
    const bool stays = deltaStream_ && !deltaStream_->empty() && deltaStream_->inValue();
    if (stays)
        flushLinksLocked();
    else
        flushLocked();
    return !stays;
}

int StreamBroadcaster::livingCount() const {
    return static_cast<int>(std::ranges::count_if(links_, [](const NodeConnection* link) {
        return link->alive() && link->feed() == NodeConnection::Feed::Direct;
    }));
}

void StreamBroadcaster::watch(int64_t nowNs, int64_t patienceNs, const std::function<void(int, bool)>& rerouted) {
    releaseReplaced();
    for (NodeConnection* link : links_) link->watch(nowNs, patienceNs);
    if (!multicast_) return;
    for (const NodeMulticast::Change& change : multicast_->takeChanges()) {
        using Kind = NodeMulticast::Change::Kind;
        NodeConnection& link = this->link(change.node);
        if (change.kind == Kind::Came && link.joinsGroup()) comers_.push_back(change);
        // or it has returned by another transport; the connection of a node that leaves reports its end
        if (!link.alive() || link.goodbyeReceived() || link.leaves() || !link.byMulticast()) continue;
        if (change.kind == Kind::Gone)
            link.lose(change.why);
        else if (change.kind == Kind::Rerouted || !change.multicast)
            rerouted(change.node, change.multicast);
    }
    std::erase_if(comers_, [&](const NodeMulticast::Change& came) {
        if (!changesOver(came)) return false;
        rerouted(came.node, came.multicast);
        return true;
    });
    // A writer may be waiting for space in a lost node's connection.
    for (NodeConnection* link : links_)
        if ((link->byMulticast() || link->joinsGroup()) && !link->alive())
            multicast_->remove(link->location().node, "the head has lost its connection to it");
}

void StreamBroadcaster::loseAll(const std::string& why) {
    for (NodeConnection* link : links_)
        if (!link->goodbyeReceived()) link->lose(why);
}

void StreamBroadcaster::end() {
    for (auto& link : owned_) link->end();
}

} // namespace mural
