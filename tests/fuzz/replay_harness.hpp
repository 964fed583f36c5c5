// Feeds bytes to class Replay, as a malicious head would. Input: one byte of options, then packets (wire::PacketHeader,
// payload; the last may be short). A packet of the head's own stream with HeadCommand::ClientGone ends a client.
#pragma once

#include <cstddef>
#include <span>

#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::fuzz {

enum Option : uint8_t { kLean = 1, kTiles = 2, kSingleBuffered = 4, kSurfacesFail = 8 };

PlayerCounts replayBytes(std::span<const std::byte> input);

} // namespace mural::fuzz
