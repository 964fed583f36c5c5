// The messages of a swap barrier: docs/reference/wire-format.md, "Swap barriers".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "nodes/swap_barrier/swap_key.hpp"

namespace mural {

// To the leader: the picture of `key` is drawn.
struct BarrierReady {
    SwapKey key;
    SwapKey shownKey;    // the previous swap
    int64_t shownNs = 0; // when it was shown, by the leader's clock; 0: not reported
    int64_t sentNs = 0;  // by its own clock
    int64_t errorNs = 0; // error of its estimate of the leader's clock; INT64_MAX: no estimate yet
};

// To a waiting member: show the picture.
struct BarrierGo {
    SwapKey key;
    int64_t readySentNs = 0; // copied from BarrierReady
    int64_t arrivedNs = 0;   // by the leader's clock, as the times below
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
