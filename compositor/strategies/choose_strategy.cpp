#include "compositor/strategies/choose_strategy.hpp"

namespace mural::compositor {

namespace {

// Longest measured chain; longer ones add a wait per rank to every picture.
constexpr int kLongestChain = 16;

} // namespace

Strategy chooseStrategy(int ranks) { return ranks <= kLongestChain ? Strategy::Streaming : Strategy::RadixK; }

const char* whyStrategy(int ranks) {
    if (chooseStrategy(ranks) == Strategy::Streaming)
        return "each folds into what its neighbour sends, the collector least of all";
    return "a chain of so many would be long; each folds a band, in rounds of up to eight";
}

} // namespace mural::compositor
