// A node's part of the statistics of frames: the spans of the replay thread, and the reply to a ClockProbe
// (docs/reference/statistics.md). Used by the replay thread.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "nodes/frame_spans/thread_spans.hpp"
#include "nodes/player/player_setup.hpp"
#include "streamcodec/wire/frame_spans.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

class ReplaySpans {
public:
    // Switches the statistics of this thread on or off.
    void record(bool isOn);
    // Does the same for the arguments of HeadCommand::Statistics. Returns false if they are invalid.
    bool record(std::span<const std::byte> arguments);
    // Planted fault: all spans are one second late.
    void delay() { isLate_ = true; }

    // Returns the spans of the frame that ends now. Empty: statistics are off, or began within this frame.
    std::vector<wire::FrameSpan> take();

private:
    ThreadSpans spans_;
    bool isPartial_ = false; // the spans may lack the begin of the frame
    bool isLate_ = false;
};

[[nodiscard]] wire::FrameSpansHeader spansHeaderOf(const wire::FrameDoneMessage& done);

// Reads the picture of a frame as a span of its own.
std::unique_ptr<PictureRead> readPicture(const PlayerOutputs::Frame& frame);

// Returns the reply to the arguments of HeadCommand::ClockProbe; empty: they are invalid.
std::optional<wire::ClockReplyMessage> clockReplyTo(std::span<const std::byte> arguments);

} // namespace mural
