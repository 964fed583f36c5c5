#include "compositor/strategies/choose_strategy.hpp"

namespace mural::compositor {

namespace {

// Up to here the collector takes no more than two others' pictures, and every other way carries some of them twice.
constexpr int kMostSerial = 3;
// Up to here direct send has small numbers of pieces, in the least steps that there are beyond one.
constexpr int kMostDirect = 8;

} // namespace

Strategy chooseStrategy(int ranks) { return ranks <= kMostSerial ? Strategy::Serial : ranks <= kMostDirect ? Strategy::DirectSend : Strategy::RadixK; }

const char* whyStrategy(int ranks) {
    switch (chooseStrategy(ranks)) {
    case Strategy::Serial: return "few nodes, nothing is carried twice";
    case Strategy::DirectSend: return "each folds one band, in two steps";
    default: return "many nodes, each folds a band in rounds of up to eight";
    }
}

} // namespace mural::compositor
