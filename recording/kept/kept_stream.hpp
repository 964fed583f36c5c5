// What a node that comes late has to be given first: the stream of all programs so far, but for what nothing depends on any more. Fed
// with every packet that goes to the nodes, in their order; used under the lock that orders them.
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
    // boundBytes: of memory. When what has to be kept does not fit, nothing is kept from then on, and `say` tells so, once.
    KeptStream(size_t boundBytes, std::function<void(const std::string&)> say) : boundBytes_(boundBytes), say_(std::move(say)) {}

    void append(uint32_t stream, std::span<const std::byte> payload); // those of the head's own stream are left out
    void event(const ClientEvent& event);                             // ClientGone: nothing of it is needed

    [[nodiscard]] bool serves() const { return !overrun_; } // false: a node can't come any more
    // Packets of programs' streams that make a fresh node what the others are now. Swaps in them are unseen (frame 0), and there
    // are no questions.
    [[nodiscard]] std::vector<KeptPacket> snapshot();
    [[nodiscard]] size_t sizeBytes() const { return log_.sizeBytes(); }
    [[nodiscard]] size_t records() const { return log_.records(); }

private:
    const size_t boundBytes_;
    const std::function<void(const std::string&)> say_;
    KeptLog log_;
    bool overrun_ = false;
};

// A swap or front picture among the records becomes one that nobody sees.
void hideFrames(std::span<std::byte> records);

} // namespace mural::recording
