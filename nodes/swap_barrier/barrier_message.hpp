// What members of a swap barrier send each other: docs/wire-format.md, "Swap barriers".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "nodes/swap_barrier/swap_key.hpp"

namespace mural {

// To the leader: its picture of `key` is drawn.
struct BarrierReady {
    SwapKey key;
    SwapKey shownKey;    // the swap before…
    int64_t shownNs = 0; // …was shown then, by the leader's clock; 0: nothing to tell
    int64_t sentNs = 0;  // by its own clock
    int64_t errorNs = 0; // how well it knows the leader's; INT64_MAX: not yet
};

// To one that waits: show it.
struct BarrierGo {
    SwapKey key;
    int64_t readySentNs = 0; // as it came
    int64_t arrivedNs = 0;   // by the leader's clock, as those below
    int64_t leftNs = 0;
    int64_t showNs = 0;
};

constexpr size_t kReadyBytes = 48;
constexpr size_t kGoBytes = 44;

std::array<std::byte, kReadyBytes> encode(const BarrierReady& ready);
std::array<std::byte, kGoBytes> encode(const BarrierGo& go);
BarrierReady decodeReady(std::span<const std::byte, kReadyBytes> bytes);
BarrierGo decodeGo(std::span<const std::byte, kGoBytes> bytes);

} // namespace mural
