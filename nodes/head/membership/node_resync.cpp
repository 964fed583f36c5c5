#include "nodes/head/membership/node_resync.hpp"

#include <algorithm>
#include <chrono>
#include <poll.h>

#include "common/log/log.hpp"
#include "nodes/head/broadcast/bytes_of.hpp"
#include "nodes/head/broadcast/head_command.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {
namespace {

constexpr int64_t kShortRoundNs = 20 * kNsPerMs; // a pause of this length is invisible
constexpr int kMaxRounds = 8;                    // a node that is no faster than the others never converges
constexpr int64_t kDrawPatienceMs = 500;         // until each window has had a frame
constexpr int64_t kDirectPatienceMs = 2'000;     // after this time the queue is flushed while other nodes wait
constexpr int kJoinPollMs = 2;                   // while other nodes of its group catch up
constexpr int64_t kSnapshotMs = 20'000;          // limit for the snapshot
constexpr int64_t kPollMs = 50;                  // interval of the check that a member is left to report the phase
constexpr int64_t kSyncLimitMs = 600'000;        // a last resort: watch() loses silent nodes earlier

} // namespace

NodeResync::NodeResync(StreamBroadcaster& nodes, int node, std::optional<StreamBroadcaster::PhaseRequest> turns,
                       Join join)
    : nodes_(nodes), node_(node), link_(nodes.link(node)), turns_(std::move(turns)), join_(std::move(join)) {}

NodeResync::~NodeResync() {
    if (thread_.joinable()) thread_.join();
}

void NodeResync::start() {
    thread_ = std::thread([this] { work(); });
}

void NodeResync::synchronized(const wire::SynchronizedMessage& message) {
    const std::lock_guard lock(mutex_);
    reached_ = message.number;
    validity_ = message.validity;
    changed_.notify_all();
}

void NodeResync::linkLost() {
    const std::lock_guard lock(mutex_);
    lost_ = true;
    changed_.notify_all();
}

void NodeResync::phaseState(uint32_t number, const std::vector<std::byte>& turns) {
    const std::lock_guard lock(mutex_);
    if (turns_ && number == turns_->number && !phase_) phase_ = turns; // all members report the same
    changed_.notify_all();
}

void NodeResync::work() {
    auto snapshot = nodes_.beginCatchUp(node_, turns_ ? &*turns_ : nullptr, Deadline::inMs(kSnapshotMs));
    if (snapshot)
        sendSnapshot(*snapshot);
    else
        link_.lose(snapshot.error().message);
    log::debug(log::Topic::Node, "resync of node ", node_, ": ", snapshotBytes_.load(), " bytes of snapshot");
    bool there = snapshot && synchronize() && sendTurns();
    for (int round = 0; there && round < kMaxRounds; ++round) {
        const int64_t beganNs = monotonicNowNs();
        sendQueue();
        there = synchronize();
        const int64_t tookNs = monotonicNowNs() - beganNs;
        log::debug(log::Topic::Node, "resync of node ", node_, ": round ", round + 1, " took ", tookNs / 1000, " us, ",
                   queuedBytes_.load(), " bytes of later commands so far");
        if (tookNs <= kShortRoundNs) break;
    }
    there = there && drawsAgain() && joins();
    const Deadline deadline = Deadline::inMs(kDirectPatienceMs);
    while (there && link_.alive() && !nodes_.goDirect(node_, deadline.passed())) sendQueue();
    if (there && link_.alive()) nodes_.inviteToGroup(node_);
    log::debug(log::Topic::Node, "resync of node ", node_, there && link_.alive() ? " is complete" : " has failed");
    done_ = true;
}

void NodeResync::sendSnapshot(const RejoinLog::Snapshot& snapshot) {
    {
        const std::lock_guard lock(mutex_);
        frames_ = snapshot.frames;
    }
    for (const snapshot::SnapshotPacket& packet : snapshot.packets) {
        if (!link_.alive()) return;
        const wire::PacketHeader header{static_cast<uint32_t>(packet.payload.size()), packet.stream};
        link_.sendNow(bytesOf(header), packet.payload);
        snapshotBytes_ += sizeof(header) + packet.payload.size();
    }
}

void NodeResync::sendQueue() {
    for (const auto& packet : link_.takeQueue()) {
        if (!link_.alive()) return;
        link_.sendNow(packet, {});
        queuedBytes_ += packet.size();
    }
    link_.flushNow();
}

// A snapshot omits frames, so the node cannot count the phase itself. Returns false if the node is lost.
bool NodeResync::sendTurns() {
    if (!turns_) return true;
    const Deadline deadline = Deadline::inMs(kSyncLimitMs);
    std::optional<std::vector<std::byte>> turns;
    do {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, std::chrono::milliseconds(kPollMs), [this] { return lost_ || phase_; });
        if (lost_) return false;
        turns = phase_;
    } while (!turns && std::ranges::any_of(turns_->members, &NodeConnection::alive) && !deadline.passed());
    if (turns) sendCommand(wire::HeadCommand::Turns, *turns);
    return true; // no member reports the phase: it restarts with the first new member
}

void NodeResync::sendCommand(wire::HeadCommand command, std::span<const std::byte> arguments) {
    const auto payload = commandBytes(command, arguments);
    const wire::PacketHeader header{static_cast<uint32_t>(payload.size()), wire::streamOf(0, 0)};
    link_.sendNow(bytesOf(header), payload);
    link_.flushNow();
}

// The next clear of each window completes the current frames. Returns false if the node is lost.
bool NodeResync::drawsAgain() {
    const Deadline deadline = Deadline::inMs(kDrawPatienceMs);
    while (synchronize(true)) {
        {
            const std::lock_guard lock(mutex_);
            invalid_ = validity_ == static_cast<uint32_t>(wire::FrameValidity::Invalid);
            if (validity_ == static_cast<uint32_t>(wire::FrameValidity::Valid)) return true;
        }
        // without draws into the window there is no frame; the node detects a later draw
        if (deadline.passed() && !invalid_) return true;
        if (invalid_) {
            link_.lose("its frames depend on earlier frames that it skipped; the next restart draws all frames");
            return false;
        }
        poll(nullptr, 0, 5);
        sendQueue();
    }
    return false;
}

// Meanwhile the node receives everything that programs send. No Synchronize: another thread may make the node a member
// at any time, and its stream is delta-coded from then on. Returns false if the node is lost.
bool NodeResync::joins() {
    while (true) {
        auto joined = join_();
        if (!joined) link_.lose(joined.error().message);
        if (!joined || *joined) return joined.ok();
        poll(nullptr, 0, kJoinPollMs);
        if (!link_.alive()) return false;
        sendQueue();
    }
}

// Returns false if the node is lost.
bool NodeResync::synchronize(bool draws) {
    const uint32_t number = ++syncNumber_;
    const uint32_t arguments[] = {number, draws ? 1U : 0U};
    sendCommand(wire::HeadCommand::Synchronize, bytesOf(arguments));
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(kSyncLimitMs), [&] { return lost_ || reached_ >= number; });
    if (!lost_ && reached_ < number) link_.lose("it did not execute its snapshot in time");
    return !lost_ && reached_ >= number;
}

} // namespace mural
