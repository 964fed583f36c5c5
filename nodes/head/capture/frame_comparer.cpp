#include "nodes/head/capture/frame_comparer.hpp"

#include <utility>

#include "common/base/clock.hpp"
#include "nodes/head/capture/frame_end.hpp"

namespace mural {

std::optional<SentFrame> FrameComparer::published(uint32_t stream, std::span<const std::byte> records) {
    const bool begins = !commands_;
    if (begins) {
        commands_.emplace();
        beganNs_ = monotonicNowNs();
    }
    // the publications of a thread divide its commands anywhere
    if (std::exchange(stream_, stream) != stream || begins) commands_->add(std::as_bytes(std::span(&stream, 1)));
    const auto end = frameEndOf(records);
    commands_->add(end ? records.first(records.size() - FrameEnd::kBytes) : records);
    if (!end) return {};
    const filter::Sum sum = commands_->sum();
    commands_.reset();
    const auto [known, isFirst] = previous_.try_emplace(end->window, sum);
    const bool isRepeated = !isFirst && std::exchange(known->second, sum) == sum;
    return SentFrame{client_, end->window, end->frame, isRepeated, beganNs_};
}

} // namespace mural
