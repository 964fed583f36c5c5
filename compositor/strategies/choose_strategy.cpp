#include "compositor/strategies/choose_strategy.hpp"

namespace mural::compositor {

namespace {

// Up to here a chain was measured, or its waits are few enough; more than that follow each other in every picture.
constexpr int kLongestChain = 16;

} // namespace

Strategy chooseStrategy(int ranks) { return ranks <= kLongestChain ? Strategy::Streaming : Strategy::RadixK; }

const char* whyStrategy(int ranks) {
    if (chooseStrategy(ranks) == Strategy::Streaming) return "each folds into what its neighbour sends, the collector least of all";
    return "a chain of so many would be long; each folds a band, in rounds of up to eight";
}

} // namespace mural::compositor
