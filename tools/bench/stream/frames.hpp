// Reads the packets of a trace, by frame of the wall.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "common/base/result.hpp"

namespace mural::bench {

struct StreamPacket {
    uint32_t stream = 0;
    std::span<const std::byte> payload;
};

struct FrameReader {
    std::function<void(const StreamPacket&)> packet;
    std::function<void(int64_t frame)> ended; // from 1; called after the packet that ends the frame
};

// Visits all packets in order. Returns the number of frames.
Result<int64_t> readFrames(const std::string& path, const FrameReader& to);

} // namespace mural::bench
