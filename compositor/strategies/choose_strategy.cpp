#include "compositor/strategies/choose_strategy.hpp"

namespace mural::compositor {

namespace {

// Longest measured chain; longer ones add a wait per rank to every picture.
constexpr int kLongestChain = 16;

} // namespace

Strategy chooseStrategy(int ranks) { return ranks <= kLongestChain ? Strategy::Streaming : Strategy::RadixK; }

const char* whyStrategy(int ranks) {
    if (chooseStrategy(ranks) == Strategy::Streaming)
        return "each node composites the picture that its neighbour sends, and the collector does the least work";
    return "a chain would be too long; each node composites a band, in rounds of up to eight nodes";
}

} // namespace mural::compositor
