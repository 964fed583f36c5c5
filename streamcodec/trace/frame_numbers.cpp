#include "streamcodec/trace/frame_numbers.hpp"

#include <cstring>

namespace mural::trace {

void FrameNumbers::apply(uint32_t stream, std::span<std::byte> records) {
    wire::RecordWalk walk(records);
    wire::RecordView r;
    while (walk.next(r)) {
        if (before_ && before_->record(stream, r) > 0) before_.reset();
        const bool isFrame = r.opcode == wire::kOpSwap || r.opcode == wire::kOpFrontPicture;
        if (!isFrame || r.arguments.size() < 8 || wire::argumentWord(r, 1) == wire::kUnseenFrame) continue;
        const uint32_t frame = before_ ? wire::kUnseenFrame : ++last_[wire::clientOf(stream)];
        std::memcpy(records.data() + r.offset + r.sizeBytes - r.arguments.size() + 4, &frame, sizeof frame);
    }
}

} // namespace mural::trace
