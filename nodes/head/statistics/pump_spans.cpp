#include "nodes/head/statistics/pump_spans.hpp"

#include <utility>

#include "nodes/head/capture/capture_memory.hpp"
#include "nodes/head/capture/frame_end.hpp"

namespace mural {

void PumpSpans::published(std::span<const std::byte> records) {
    if (!spans_.isActive()) return;
    const auto end = frameEndOf(records);
    if (!end || end->frame == wire::kUnseenFrame) return;
    endedFrame_ = end->frame;
    publishedNs_ = quickNowNs();
}

void PumpSpans::sent() {
    if (!statistics_) return;
    const bool begins = statistics_->isOn() && !spans_.isActive();
    recordThread(spans_, statistics_->isOn(), SpanKind::Send);
    if (begins) {
        endedFrame_ = 0;
        frameNs_ = quickNowNs();
        waits_ = memory_.waitNs();
    }
    const uint32_t frame = std::exchange(endedFrame_, 0);
    if (frame == 0 || !spans_.isActive()) return;
    const int64_t nowNs = quickNowNs();
    const int64_t beganNs = std::exchange(frameNs_, publishedNs_);
    const ProgramWaits before = std::exchange(waits_, memory_.waitNs());
    statistics_->add(client_, frame,
                     {SpanProcess::Program, 0, "gl", programSpans(beganNs, publishedNs_, before, waits_)}, nowNs);
    statistics_->add(client_, frame, {SpanProcess::Head, 0, "stream", spans_.take(nowNs)}, nowNs);
}

} // namespace mural
