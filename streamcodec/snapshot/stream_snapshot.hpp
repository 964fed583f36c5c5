// Produces snapshots for restarted nodes: the stream of all programs so far, without commands that have no remaining
// effect. Receives every packet in broadcast order. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "streamcodec/snapshot/live_command_log.hpp"
#include "streamcodec/snapshot/snapshot_packet.hpp"

namespace mural::snapshot {

class StreamSnapshot {
public:
    // boundBytes: memory limit. Recording of the live state stops when it exceeds the limit.
    explicit StreamSnapshot(size_t boundBytes) : boundBytes_(boundBytes) {}

    void append(uint32_t stream, std::span<const std::byte> payload); // ignores the head's own stream
    void clientGone(uint32_t client);                                 // removes everything of the program

    [[nodiscard]] bool serves() const { return !overrun_; } // false: nodes can no longer resynchronize
    // Returns packets that bring a fresh node to the current state. Swaps in them are unseen (frame 0), and they
    // contain no requests.
    [[nodiscard]] std::vector<SnapshotPacket> snapshot();
    [[nodiscard]] size_t sizeBytes() const { return log_.sizeBytes(); }
    [[nodiscard]] size_t records() const { return log_.records(); }

private:
    const size_t boundBytes_;
    LiveCommandLog log_;
    bool overrun_ = false;
};

// Turns swaps and front pictures into unseen frames.
void hideFrames(std::span<std::byte> records);

} // namespace mural::snapshot
