// Numbers the frames of a stream that begins later than its programs, as a trace must have them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "streamcodec/trace/wall_frames.hpp"

namespace mural::trace {

class FrameNumbers {
public:
    FrameNumbers() = default;
    // wall: the frames before the stream. Frames of other windows become unseen until the next frame of the wall.
    explicit FrameNumbers(WallFrames wall) : before_(std::move(wall)) {}

    // Numbers the visible frames of a packet from 1 by program, in the order of the stream.
    void apply(uint32_t stream, std::span<std::byte> records);
    void clientGone(uint32_t client) {
        if (before_) before_->clientGone(client);
    }

private:
    std::map<uint32_t, uint32_t> last_;
    std::optional<WallFrames> before_; // nothing from the first frame of the wall on
};

} // namespace mural::trace
