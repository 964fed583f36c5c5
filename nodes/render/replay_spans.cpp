#include "nodes/render/replay_spans.hpp"

#include <utility>

#include "common/base/clock.hpp"
#include "common/base/quick_clock.hpp"
#include "nodes/frame_spans/frame_spans_message.hpp"
#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/render/command_arguments.hpp"

namespace mural {

void ReplaySpans::record(bool isOn) { recordThread(spans_, isOn, SpanKind::Replay); }

bool ReplaySpans::record(std::span<const std::byte> arguments) {
    const auto on = argument<uint32_t>(arguments);
    if (!on) return false;
    if (*on != 0 && !spans_.isActive()) isPartial_ = true;
    record(*on != 0);
    return true;
}

std::vector<wire::FrameSpan> ReplaySpans::take() {
    std::vector<wire::FrameSpan> spans;
    if (spans_.isActive()) addSpans(spans, wire::SpanThread::Replay, spans_.take(quickNowNs()));
    if (std::exchange(isPartial_, false)) return {};
    if (isLate_)
        for (wire::FrameSpan& span : spans) span.beginNs += kNsPerS, span.endNs += kNsPerS;
    return spans;
}

wire::FrameSpansHeader spansHeaderOf(const wire::FrameDoneMessage& done) {
    return {done.client, done.window, done.frame, 0, quickNowNs()};
}

std::unique_ptr<PictureRead> readPicture(const PlayerOutputs::Frame& frame) {
    const SpanScope reads(SpanKind::Readback);
    return frame.read();
}

std::optional<wire::ClockReplyMessage> clockReplyTo(std::span<const std::byte> arguments) {
    wire::ClockReplyMessage reply{};
    reply.arrivedNs = monotonicNowNs();
    const auto sentNs = argument<int64_t>(arguments);
    if (!sentNs) return std::nullopt;
    reply.sentNs = *sentNs;
    reply.leftNs = monotonicNowNs();
    return reply;
}

} // namespace mural
