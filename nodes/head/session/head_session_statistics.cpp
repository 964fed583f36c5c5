// The session's part of the statistics of frames (docs/reference/statistics.md).
#include <algorithm>
#include <nlohmann/json.hpp>
#include <poll.h>

#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/head/broadcast/bytes_of.hpp"
#include "nodes/head/session/head_session.hpp"
#include "nodes/head/statistics/frames_reply.hpp"
#include "streamcodec/wire/head_messages.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

constexpr int kProbes = 8;                   // at the start, while the nodes are idle
constexpr int64_t kProbeMs = 20;             // limit for a reply
constexpr int64_t kProbeNs = 500 * kNsPerMs; // interval while statistics are on

Json clocksJson(const std::vector<NodeClock>& clocks) {
    Json list = Json::array();
    for (size_t node = 0; node < clocks.size(); ++node) {
        if (!clocks[node].isKnown()) continue;
        list.push_back({{"node", node}, {"offsetNs", clocks[node].offsetNs()}, {"errorNs", clocks[node].errorNs()}});
    }
    return list;
}

} // namespace

void HeadSession::addFramesOperation(ControlOperations& operations) {
    operations.add({"frames",
                    "",
                    "statistics of complete frames; the session records them until 10 s after the last request",
                    {{"since", ControlArgument::Kind::Whole, false, "number of the first frame, from 1"},
                     {"newest", ControlArgument::Kind::Whole, false, "leave all but this number of frames out"}},
                    [this](const Json& arguments) -> Result<Json> {
                        const auto since = arguments.value("since", int64_t{1});
                        if (since < 1) return Error{"since is the number of a frame; frames have numbers from 1 on"};
                        const auto newest = arguments.value("newest", static_cast<int64_t>(FrameRing::kFrames));
                        if (newest < 0) return Error{"newest is a number of frames, from 0 on"};
                        return framesJson(static_cast<uint64_t>(since), static_cast<size_t>(newest));
                    }});
}

Json HeadSession::framesJson(uint64_t sinceFrame, size_t newest) {
    const int64_t nowNs = monotonicNowNs();
    if (statistics_.request(nowNs)) announceStatistics();
    Json reply = framesReply(statistics_.since(sinceFrame, nowNs, newest), sinceFrame);
    reply["kinds"] = wire::kSpanKindNames;
    reply["clocks"] = clocksJson(statistics_.clocks());
    reply["status"] = statusOf(status());
    return reply;
}

// Announces the current state. The command precedes the next packet of a program, because the calling thread must not
// wait for a node. The lock orders the announcements of two threads.
void HeadSession::announceStatistics() {
    const std::lock_guard lock(announceMutex_);
    const uint32_t argument = statistics_.isOn() ? 1 : 0;
    nodes_.scheduleBeforeNextPacket(wire::HeadCommand::Statistics, bytesOf(argument));
}

void HeadSession::tickStatistics(int64_t nowNs) {
    if (statistics_.expire(nowNs)) announceStatistics();
    if (!statistics_.isOn() || nowNs - probedNs_ < kProbeNs) return;
    probedNs_ = nowNs;
    const auto plan = currentPlan();
    if (std::ranges::any_of(plan->nodes, [](const NodePlan& n) { return n.reach != NodeReach::SharedMemory; }))
        nodes_.scheduleBeforeNextPacket(wire::HeadCommand::ClockProbe, bytesOf(nowNs));
}

// Called by the thread that reads the node's messages, after the frame was counted. The spans of that thread begin with
// its first frame.
Result<void> HeadSession::recordFrame(int node, const wire::FrameDoneMessage& message, Result<void> counted) {
    thread_local ThreadSpans spans;
    recordThread(spans, statistics_.isOn(), SpanKind::Receive);
    if (!spans.isActive()) return counted;
    const int64_t nowNs = quickNowNs();
    statistics_.add(message.client, message.frame, {SpanProcess::Head, node, "reader", spans.take(nowNs)}, nowNs);
    if (frames_.progressOf(message.client).finished >= message.frame)
        statistics_.finish(message.client, message.window, message.frame, nowNs);
    return counted;
}

Result<void> HeadSession::nodeFrameSpans(int node, const wire::FrameSpansHeader& header,
                                         const std::vector<wire::FrameSpan>& spans) {
    statistics_.addNode(node, header, spans, monotonicNowNs());
    return {};
}

Result<void> HeadSession::nodeClock(int node, const wire::ClockReplyMessage& message) {
    statistics_.addRoundTrip(node, {message.sentNs, message.arrivedNs, message.leftNs, monotonicNowNs()});
    return {};
}

bool HeadSession::areClocksKnown() const {
    const std::vector<NodeClock> clocks = statistics_.clocks();
    for (size_t node = 0; node < clocks.size(); ++node)
        if (!clocks[node].isKnown() && !absences_.contains(static_cast<int>(node))) return false;
    return true;
}

// The nodes draw nothing yet, so they reply at once.
void HeadSession::measureClocks() {
    if (areClocksKnown()) return; // all nodes are on this machine
    for (int i = 0; i < kProbes; ++i) {
        const int64_t nowNs = monotonicNowNs();
        nodes_.broadcast(wire::HeadCommand::ClockProbe, bytesOf(nowNs));
        const Deadline deadline = Deadline::inMs(i == 0 ? kProbeMs : 2);
        while (!deadline.passed() && (i > 0 || !areClocksKnown())) poll(nullptr, 0, 1);
    }
}

} // namespace mural
