#include "native/session/app_link.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/ipc/futex.hpp"
#include "streamcodec/wire/object_records.hpp"

namespace mural::native {

namespace {

constexpr uint32_t kWindow = 1;              // id of the only window
constexpr int64_t kSliceNs = 2'000'000;      // between checks for the end of the head
constexpr int64_t kIdleSliceNs = 50'000'000; // of the link's thread while no node sends
constexpr int kBusySlices = 10;              // of kSliceNs, after a message of a node

} // namespace

Result<std::unique_ptr<AppLink>> AppLink::connect(const std::string& session, Deadline deadline) {
    auto link = CaptureLink::connect(session, capture::ProgramKind::Native, deadline);
    if (!link) return link.error();
    return std::unique_ptr<AppLink>(new AppLink(std::move(*link)));
}

void AppLink::start(NodeReports reports) {
    take_ = std::move(reports);
    link_->onReply([this](const wire::ReplyHeader& header, std::span<const std::byte> bytes) {
        hasTaken_ = true;
        take(take_, header, bytes);
    });
    reports_ = std::thread([this] { takeReports(); });
}

void AppLink::wake() { futexWakeAll(link_->answersWord()); }

void AppLink::stop() {
    isStopping_ = true;
    wake();
    if (reports_.joinable()) reports_.join();
}

void AppLink::take(const NodeReports& reports, const wire::ReplyHeader& header, std::span<const std::byte> bytes) {
    switch (static_cast<wire::ReplyKind>(header.kind)) {
    case wire::ReplyKind::Object: return reports.message(header.requestId, bytes);
    case wire::ReplyKind::Member:
        if (bytes.empty()) return reports.lost(header.requestId);
        return reports.came(header.requestId, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    default: return;
    }
}

void AppLink::takeReports() {
    reporter_ = std::this_thread::get_id();
    int busy = 0;
    while (!isStopping_) {
        const uint32_t seen = link_->answersWord().load();
        (void)link_->unanswered();
        if (std::exchange(hasTaken_, false)) busy = kBusySlices;
        take_.tick(monotonicNowNs());
        bool isWaiting = false; // packets for which the ring has no room
        if (busy > 0) isWaiting = !flush();
        busy = isWaiting ? kBusySlices : std::max(busy - 1, 0);
        futexWait(link_->answersWord(), seen, busy > 0 ? kSliceNs : kIdleSliceNs);
    }
}

void AppLink::setDeadline(Deadline deadline) {
    const std::lock_guard lock(sending_);
    deadline_ = deadline;
}

PacketWriter& AppLink::writerFor(uint16_t receivers) {
    const auto found = writers_.find(receivers);
    if (found != writers_.end()) return found->second;
    auto to = [this, receivers](std::span<const std::byte> packet) { return send(receivers, packet); };
    return writers_.emplace(receivers, PacketWriter(std::move(to))).first->second;
}

void AppLink::toOne(objects::PeerId node, std::span<const std::byte> message) {
    if (node <= wire::kMaxAddressedNode) sendObject(wire::toNode(node), message);
}

void AppLink::sendObject(uint16_t receivers, std::span<const std::byte> message) {
    const std::lock_guard lock(sending_);
    PacketWriter& writer = writerFor(receivers);
    wire::splitIntoRecords(message, [&writer](std::span<const std::byte> record) { writer.add(record); });
    // Bounds the memory of packets that the nodes do not accept.
    constexpr size_t kMaxWaitingBytes = size_t{64} << 20;
    constexpr int64_t kPatienceMs = 60'000;
    const bool mayWait = std::this_thread::get_id() != reporter_.load();
    if (mayWait && writer.waitingBytes() > kMaxWaitingBytes && deadline_.passed())
        deadline_ = Deadline::inMs(kPatienceMs);
    (void)writer.sendComplete();
}

void AppLink::sendWindow(const wire::WindowConfig& window) {
    std::byte arguments[sizeof(uint32_t) + sizeof window];
    std::memcpy(arguments, &kWindow, sizeof kWindow);
    std::memcpy(arguments + sizeof kWindow, &window, sizeof window);
    const std::lock_guard lock(sending_);
    writerFor(wire::kToAllNodes).add(wire::kOpWindow, arguments);
}

Result<void> AppLink::sendFrame(const wire::NativeFrame& frame, uint32_t number) {
    const std::lock_guard lock(sending_);
    if (auto sent = flushLocked(); !sent) return sent;
    const uint32_t swap[2] = {kWindow, number};
    PacketWriter& writer = writerFor(wire::kToAllNodes);
    writer.add(wire::kOpFrame, std::as_bytes(std::span(&frame, 1)));
    writer.add(wire::kOpSwap, std::as_bytes(std::span(swap)));
    const auto sent = writer.flush(); // after the deadline, the next call sends it
    if (!sent && !isAlive()) return sent;
    link_->submitted(number);
    return {};
}

Result<void> AppLink::flush() {
    const std::lock_guard lock(sending_);
    return flushLocked();
}

Result<void> AppLink::flushLocked() {
    for (auto& [receivers, writer] : writers_)
        if (auto sent = writer.flush(); !sent) return sent;
    return {};
}

// The link's thread sends the rest later, because replies of nodes must not wait for room in the ring.
Result<void> AppLink::send(uint16_t receivers, std::span<const std::byte> packet) {
    while (!link_->publish(receivers, packet)) {
        const uint32_t seen = link_->chunkWord().load();
        if (link_->publish(receivers, packet)) break;
        if (!isAlive()) return Error{"the session is over"};
        if (deadline_.passed() || std::this_thread::get_id() == reporter_.load())
            return Error{"the render nodes accept no more data; see mural stat"};
        futexWait(link_->chunkWord(), seen, deadline_.leftNs(kSliceNs));
    }
    return {};
}

template <class Condition>
Result<void> AppLink::await(const std::atomic<uint32_t>& word, const char* what, Condition condition) {
    while (true) {
        const uint32_t seen = word.load();
        if (condition()) return {};
        if (!isAlive()) return Error{"the session is over"};
        if (auto sent = flush(); !sent) return sent;
        const Deadline deadline = [this] {
            const std::lock_guard lock(sending_);
            return deadline_;
        }();
        if (deadline.passed()) return Error{std::string(what) + "; see mural stat"};
        futexWait(word, seen, deadline.leftNs(kSliceNs));
    }
}

Result<void> AppLink::awaitCredit(uint32_t frame) {
    return await(link_->framesWord(), "the render nodes have not finished earlier frames in time",
                 [&] { return link_->mayGoOn(frame); });
}

Result<void> AppLink::awaitDone(uint32_t frame) {
    return await(link_->framesWord(), "the render nodes have not finished all frames in time",
                 [&] { return static_cast<int32_t>(link_->framesWord().load() - frame) >= 0; });
}

void AppLink::sleepUntil(Deadline deadline) {
    (void)flush();
    while (isAlive() && !deadline.passed())
        futexWait(link_->framesWord(), link_->framesWord().load(), deadline.leftNs(kIdleSliceNs));
}

} // namespace mural::native
