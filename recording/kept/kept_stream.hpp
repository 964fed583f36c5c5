// Produces snapshots for restarted nodes: the stream of all programs so far, without commands that have no remaining
// effect. Receives every packet in broadcast order. Requires the broadcaster's lock.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "recording/entry.hpp"
#include "recording/kept/kept_log.hpp"
#include "recording/kept/kept_packet.hpp"

namespace mural::recording {

class KeptStream {
public:
    // boundBytes: memory limit. If the live state exceeds it, logging stops, and `say` reports it once.
    KeptStream(size_t boundBytes, std::function<void(const std::string&)> say) : boundBytes_(boundBytes), say_(std::move(say)) {}

    void append(uint32_t stream, std::span<const std::byte> payload); // ignores the head's own stream
    void event(const ClientEvent& event); // ClientGone: removes everything of the program

    [[nodiscard]] bool serves() const { return !overrun_; } // false: nodes can no longer resynchronize
    // Returns packets that bring a fresh node to the current state. Swaps in them are unseen (frame 0), and they
    // contain no requests.
    [[nodiscard]] std::vector<KeptPacket> snapshot();
    [[nodiscard]] size_t sizeBytes() const { return log_.sizeBytes(); }
    [[nodiscard]] size_t records() const { return log_.records(); }

private:
    const size_t boundBytes_;
    const std::function<void(const std::string&)> say_;
    KeptLog log_;
    bool overrun_ = false;
};

// Turns swaps and front pictures into unseen frames.
void hideFrames(std::span<std::byte> records);

} // namespace mural::recording
