// The return of restarted nodes, and the leave of members. The lock that orders packets guards the choice of the
// snapshot's position and of the position where the node becomes a member. The transfer of the snapshot runs without
// the lock.
#include <algorithm>
#include <chrono>
#include <cstring>

#include "common/log/log.hpp"
#include "nodes/head/broadcast/bytes_of.hpp"
#include "nodes/head/broadcast/head_command.hpp"
#include "nodes/head/broadcast/stream_broadcaster.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {
namespace {

constexpr int64_t kChangeOverMs = 5; // how long watch() waits for the lock per attempt

} // namespace

void StreamBroadcaster::keepLocked(uint32_t stream, std::span<const std::byte> payload) {
    if (!rejoinLog_) return;
    uint32_t words[2] = {};
    if (wire::clientOf(stream) != 0) {
        rejoinLog_->append(stream, payload);
    } else if (payload.size() >= sizeof(words)) {
        std::memcpy(words, payload.data(), sizeof(words));
        if (words[0] == static_cast<uint32_t>(wire::HeadCommand::ClientGone)) rejoinLog_->programGone(words[1]);
    }
}

void StreamBroadcaster::replace(int node, std::unique_ptr<NodeConnection> link) {
    NodeConnection& before = this->link(node);
    before.end();
    if (before.byMulticast() || before.joinsGroup()) multicast_->remove(node, "the head has lost its connection to it");
    std::erase_if(comers_, [node](const NodeMulticast::Change& came) { return came.node == node; });
    replaced_.push_back(&before);
    link->setFeed(NodeConnection::Feed::Nothing);
    link->setMember(false);
    links_[static_cast<size_t>(node)] = link.get();
    owned_.push_back(std::move(link));
}

// A sender may still use the connection of a replaced link while it holds the lock. The thread of its resync has ended.
void StreamBroadcaster::releaseReplaced() {
    if (replaced_.empty()) return;
    const std::unique_lock lock(sendMutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    for (NodeConnection* const link : replaced_) link->release();
    replaced_.clear();
}

Result<RejoinLog::Snapshot> StreamBroadcaster::beginCatchUp(int node, PhaseRequest* turns, Deadline deadline) {
    uint64_t position = 0;
    {
        ++joining_;
        const std::lock_guard lock(sendMutex_);
        --joining_;
        position = rejoinLog_->pause();
        if (turns) {
            for (NodeConnection* link : links_)
                if (link->member() && link->alive() && turns->knows(link->location().node))
                    turns->members.push_back(link);
            sendLocked(wire::streamOf(0, 0),
                       commandBytes(wire::HeadCommand::RequestPhase, std::as_bytes(std::span(&turns->number, 1))));
            flushLocked();
        }
        link(node).setFeed(NodeConnection::Feed::Queued);
    }
    return rejoinLog_->snapshot(position, deadline);
}

// Constructs the dictionary of a node that receives batches. Takes long, so call it without the lock.
Result<StreamBroadcaster::History> StreamBroadcaster::freshHistory(int node) {
    if (!link(node).joinsBatches()) return History();
    return DeltaStream::freshCoder(deltaStream_->limits());
}

// history: on return the previous dictionary, which the caller destroys without the lock.
void StreamBroadcaster::admitLocked(int node, const Admission& admission, History& history) {
    NodeConnection& to = link(node);
    std::vector<uint32_t> arguments = {view_, static_cast<uint32_t>(node), admission.first ? 1U : 0U,
                                       admission.incarnation};
    arguments.insert(arguments.end(), admission.absent.begin(), admission.absent.end());
    sendLocked(wire::streamOf(0, 0), commandBytes(wire::HeadCommand::Activate, std::as_bytes(std::span(arguments))));
    to.setMember(true);
    log::debug(log::Topic::Node, "node ", node, " is a member from view ", view_, " on, incarnation ",
               admission.incarnation);
    if (!history) return;
    // The last batch of the old dictionary announces the new one. This node receives batches from here on.
    const auto reset = commandBytes(wire::HeadCommand::ResetDictionary, {});
    deltaStream_->add(wire::streamOf(0, 0), reset);
    sendBatchLocked();
    history = deltaStream_->restart(std::move(history));
    const wire::PacketHeader header{static_cast<uint32_t>(reset.size()), wire::streamOf(0, 0)};
    sendTo(to, std::as_bytes(std::span(&header, 1)), reset);
    to.setInBatches(true);
}

Result<void> StreamBroadcaster::admit(int node, const std::function<Admission(uint32_t view)>& announce) {
    auto history = freshHistory(node);
    if (!history) return history.error();
    ++joining_;
    const std::lock_guard lock(sendMutex_);
    --joining_;
    sendBatchLocked();
    const Admission admission = announce(++view_);
    if (admission.refused) return {};
    admitLocked(node, admission, *history);
    flushLocked();
    return {};
}

// Packets of programs are neither between two of the commands nor lost: every frame belongs to one set of members.
Result<void> StreamBroadcaster::exchangeMembers(const MemberExchange& exchange, Deadline deadline) {
    std::vector<History> histories;
    for (const int node : exchange.joining) {
        auto history = freshHistory(node);
        if (!history) return history.error();
        histories.push_back(std::move(*history));
    }
    ++joining_;
    const std::unique_lock lock(sendMutex_, std::chrono::nanoseconds(deadline.leftNs(60 * kNsPerS)));
    --joining_;
    if (!lock.owns_lock()) return Error{"a node accepts no data at the moment; see mural stat, and try again"};
    sendBatchLocked();
    if (!exchange.atPosition(view_ + 1)) return Error{"a node was lost meanwhile"};
    const uint32_t marker[] = {++view_, wire::kNoNode, 0, 0};
    sendLocked(wire::streamOf(0, 0), commandBytes(wire::HeadCommand::Activate, bytesOf(marker)));
    { // assignments to the earlier nodes
        const std::lock_guard leads(leadMutex_);
        leads_.erase(wire::HeadCommand::ViewportAssignment);
        leads_.erase(wire::HeadCommand::RangeAssignment);
    }
    // They may have received areas of the earlier nodes.
    if (!exchange.viewports.ofNodes.empty())
        sendLocked(wire::streamOf(0, 0),
                   commandBytes(wire::HeadCommand::ViewportAssignment, bytesOf(exchange.viewports)));
    for (size_t i = 0; i < exchange.joining.size(); ++i) {
        const Admission admission = exchange.announce(exchange.joining[i], ++view_);
        admitLocked(exchange.joining[i], admission, histories[i]);
    }
    for (const int node : exchange.leaving) dismissLocked(node);
    flushLocked();
    return {};
}

bool StreamBroadcaster::goDirect(int node, bool now) {
    ++joining_;
    const std::lock_guard lock(sendMutex_);
    --joining_;
    NodeConnection& to = link(node);
    if (now)
        for (const auto& packet : to.takeQueue()) to.sendNow(packet, {});
    if (!to.queueEmpty()) return false;
    if (!to.member()) return true; // dismissed meanwhile: nothing may follow its Leave
    to.setFeed(NodeConnection::Feed::Direct);
    to.flushNow();
    return true;
}

bool StreamBroadcaster::dismiss(int node, Deadline deadline) {
    ++joining_;
    const std::unique_lock lock(sendMutex_, std::chrono::nanoseconds(deadline.leftNs(60 * kNsPerS)));
    --joining_;
    if (!lock.owns_lock()) return false;
    dismissLocked(node);
    flushLocked();
    return true;
}

void StreamBroadcaster::dismissLocked(int node) {
    const auto number = static_cast<uint32_t>(node);
    // other nodes ignore it
    sendLocked(wire::streamOf(0, 0), commandBytes(wire::HeadCommand::Leave, std::as_bytes(std::span(&number, 1))));
    sendBatchLocked();
    NodeConnection& from = link(node);
    if (!from.byMulticast()) from.flush();
    from.setLeaves();
    from.setFeed(NodeConnection::Feed::Nothing);
    from.setMember(false);
    from.setInBatches(false);
}

void StreamBroadcaster::retire(int node) {
    NodeConnection& before = this->link(node);
    before.end();
    if (before.byMulticast() || before.joinsGroup()) multicast_->remove(node, "it has left the session");
    std::erase_if(comers_, [node](const NodeMulticast::Change& came) { return came.node == node; });
    replaced_.push_back(&before);
}

void StreamBroadcaster::inviteToGroup(int node) {
    if (!multicast_ || !link(node).joinsGroup()) return;
    ++joining_;
    const std::lock_guard lock(sendMutex_);
    --joining_;
    const auto number = static_cast<uint32_t>(node);
    // other nodes ignore it
    sendLocked(wire::streamOf(0, 0),
               commandBytes(wire::HeadCommand::JoinMulticast, std::as_bytes(std::span(&number, 1))));
    flushLocked();
}

// Switches the node from its connection to the group, at one packet or batch. The node has received the group's data
// since it joined. Returns false if writers are busy, possibly with a node that watch() must lose.
bool StreamBroadcaster::changesOver(const NodeMulticast::Change& came) {
    NodeConnection& to = link(came.node);
    ++joining_;
    const std::unique_lock lock(sendMutex_, std::chrono::milliseconds(kChangeOverMs));
    --joining_;
    if (!lock.owns_lock()) return false;
    if (!to.alive() || !to.member() || to.byMulticast()) return true;
    sendBatchLocked();
    const uint64_t skipBytes = multicast_->writtenBytes() - came.fromByte;
    const wire::SwitchToMulticastCommand command{static_cast<uint32_t>(came.node), static_cast<uint32_t>(skipBytes),
                                                 static_cast<uint32_t>(skipBytes >> 32)};
    changingOver_ = &to;
    sendLocked(wire::streamOf(0, 0),
               commandBytes(wire::HeadCommand::SwitchToMulticast, std::as_bytes(std::span(&command, 1))));
    sendBatchLocked();
    changingOver_ = nullptr;
    flushLinksLocked();
    to.setByMulticast(true);
    log::debug(log::Topic::Stream, "node ", came.node, " receives by multicast from now on, ", skipBytes,
               " bytes after it joined");
    return true;
}

} // namespace mural
