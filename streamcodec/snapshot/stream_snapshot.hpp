// Keeps the streams of captured programs, without commands that have no remaining effect. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "streamcodec/snapshot/live_command_log.hpp"
#include "streamcodec/snapshot/kept_stream.hpp"

namespace mural::snapshot {

class StreamSnapshot final : public KeptStream {
public:
    // boundBytes: memory limit. Recording of the live state stops when it exceeds the limit.
    explicit StreamSnapshot(size_t boundBytes) : boundBytes_(boundBytes) {}

    void append(uint32_t stream, std::span<const std::byte> payload) override;
    void clientGone(uint32_t client) override;
    [[nodiscard]] bool serves() const override { return !overrun_; }
    [[nodiscard]] std::vector<SnapshotPacket> snapshot() override;
    [[nodiscard]] size_t sizeBytes() const override { return log_.sizeBytes(); }
    [[nodiscard]] size_t records() const { return log_.records(); }

private:
    const size_t boundBytes_;
    LiveCommandLog log_;
    bool overrun_ = false;
};

// Turns swaps and front pictures into unseen frames.
void hideFrames(std::span<std::byte> records);

} // namespace mural::snapshot
