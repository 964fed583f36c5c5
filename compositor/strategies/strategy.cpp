#include "compositor/strategies/strategy.hpp"

namespace mural::compositor {

const char* nameOf(Strategy strategy) {
    switch (strategy) {
    case Strategy::Serial: return "serial";
    case Strategy::DirectSend: return "direct-send";
    case Strategy::BinarySwap: return "binary-swap";
    case Strategy::TwoThreeSwap: return "2-3-swap";
    case Strategy::RadixK: return "radix-k";
    case Strategy::Streaming: return "streaming";
    }
    return "serial";
}

std::optional<Strategy> strategyNamed(std::string_view name) {
    for (const Strategy s : kEveryStrategy)
        if (name == nameOf(s)) return s;
    return std::nullopt;
}

} // namespace mural::compositor
