#include "nodes/head/statistics/pump_spans.hpp"

#include <array>
#include <cstring>
#include <utility>

#include "nodes/head/capture/capture_memory.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {
namespace {

// Returns the number of the frame that the last record ends; 0: none.
uint32_t frameEndedBy(std::span<const std::byte> records) {
    std::array<uint32_t, 3> last{}; // header, window, frame
    if (records.size() < sizeof last) return 0;
    std::memcpy(last.data(), records.data() + records.size() - sizeof last, sizeof last);
    constexpr uint32_t kWords = 3U << 16;
    const bool isEnd = last[0] == (wire::kOpSwap | kWords) || last[0] == (wire::kOpFrontPicture | kWords);
    return isEnd && last[2] != wire::kUnseenFrame ? last[2] : 0;
}

} // namespace

void PumpSpans::published(std::span<const std::byte> records) {
    if (!spans_.isActive()) return;
    const uint32_t frame = frameEndedBy(records);
    if (frame == 0) return;
    endedFrame_ = frame;
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
