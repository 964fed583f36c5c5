// Keeps the state of streams, and produces snapshots of it for restarted nodes. One class per kind of stream. Not
// thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "streamcodec/snapshot/snapshot_packet.hpp"

namespace mural::snapshot {

class KeptStream {
public:
    virtual ~KeptStream() = default;
    // Receives every packet in broadcast order. Ignores the head's own stream.
    virtual void append(uint32_t stream, std::span<const std::byte> payload) = 0;
    virtual void clientGone(uint32_t client) = 0; // removes everything of the program

    [[nodiscard]] virtual bool serves() const = 0; // false: nodes can no longer resynchronize
    // Returns packets that bring a fresh node to the current state. Swaps in them are unseen (frame 0), and they
    // contain no requests.
    [[nodiscard]] virtual std::vector<SnapshotPacket> snapshot() = 0;
    [[nodiscard]] virtual size_t sizeBytes() const = 0;
};

} // namespace mural::snapshot
