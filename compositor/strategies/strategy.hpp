// Strategies of sort-last compositing over several ranks. All give the same picture; they differ in transfers and work
// per rank, and in the number of sequential steps.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace mural::compositor {

enum class Strategy : uint8_t {
    Serial,       // the collector composites everything
    DirectSend,   // each rank composites one band and sends it to the collector
    BinarySwap,   // pairs swap halves, then quarters, ...; the remainder beyond a power of two is composited first
    TwoThreeSwap, // groups of two and three, for any number of ranks
    RadixK,       // groups of up to eight
    Streaming,    // a chain: each rank composites its neighbour's bands and passes them on
};
constexpr Strategy kEveryStrategy[] = {Strategy::Serial,       Strategy::DirectSend, Strategy::BinarySwap,
                                       Strategy::TwoThreeSwap, Strategy::RadixK,     Strategy::Streaming};

// Names on the command line: serial, direct-send, binary-swap, 2-3-swap, radix-k, streaming.
[[nodiscard]] const char* nameOf(Strategy strategy);
[[nodiscard]] std::optional<Strategy> strategyNamed(std::string_view name);

} // namespace mural::compositor
