// The ways in which the pictures of several nodes, each with a range of the draws, become one. All give the same picture; they
// differ in how much each node carries and folds, and in how many steps follow each other.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace mural::compositor {

enum class Strategy : uint8_t {
    Serial,       // all send to the collector, which folds alone
    DirectSend,   // each node folds one band of the picture, and sends it to the collector
    BinarySwap,   // pairs swap halves, then quarters, …; what is beyond a power of two is folded first
    TwoThreeSwap, // the same by groups of two and three, for any number of nodes
    RadixK,       // the same by groups of up to eight
    Streaming,    // a chain: each node folds into what comes from its neighbour, band by band
};
constexpr Strategy kEveryStrategy[] = {Strategy::Serial, Strategy::DirectSend, Strategy::BinarySwap, Strategy::TwoThreeSwap, Strategy::RadixK, Strategy::Streaming};

// As users write them: serial, direct-send, binary-swap, 2-3-swap, radix-k, streaming.
[[nodiscard]] const char* nameOf(Strategy strategy);
[[nodiscard]] std::optional<Strategy> strategyNamed(std::string_view name);

} // namespace mural::compositor
