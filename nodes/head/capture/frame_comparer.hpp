// Compares the commands of each frame of a program with those of the previous frame of the same window. Used by the
// pump's thread.
//
// Frame numbers of swaps are excluded. Requests have numbers of their own, so frames with requests always differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "streamcodec/filter/upload.hpp"

namespace mural {

// A frame whose commands were all sent to the nodes.
struct SentFrame {
    uint32_t client = 0;
    uint32_t window = 0;
    uint32_t frame = 0;      // or wire::kUnseenFrame
    bool isRepeated = false; // the commands equal those of the previous frame
    int64_t beganNs = 0;     // arrival of the first commands
};

class FrameComparer {
public:
    explicit FrameComparer(uint32_t client) : client_(client) {}

    // Call for each publication of any thread of the program, in order. Returns the frame that it ends, if any.
    std::optional<SentFrame> published(uint32_t stream, std::span<const std::byte> records);

private:
    const uint32_t client_;
    std::optional<filter::Summing> commands_; // since the last end of a frame; empty: none yet
    uint32_t stream_ = 0;                     // of the latest commands
    int64_t beganNs_ = 0;
    std::map<uint32_t, filter::Sum> previous_; // by window
};

} // namespace mural
