// Radix-k: n is a product of factors up to eight; in each round groups of that size swap, each member with all others
// at once. Fewer rounds than binary swap, fewer simultaneous pieces than direct send. If n has larger prime factors,
// the largest smaller number without them swaps, and the rest is composited into neighbours first. Source: Peterka,
// Goodell, Ross, Shen, Thakur, "A configurable algorithm for parallel image-compositing applications" (2009).
#include "compositor/strategies/swap_groups.hpp"

namespace mural::compositor {

namespace {

constexpr int kLargestFactor = 8;

// Returns the largest factor of a round; 1: none.
int factorOf(int n) {
    for (int k = kLargestFactor; k > 1; --k)
        if (n % k == 0) return k;
    return 1;
}

bool factors(int n) {
    while (n > 1 && factorOf(n) > 1) n /= factorOf(n);
    return n == 1;
}

} // namespace

void makeRadixK(ScheduleMaker& maker) {
    int swapping = maker.ranks();
    while (!factors(swapping)) --swapping; // ends at a power of two: more than half of the ranks
    swapGroups(maker, foldRemainder(maker, swapping), [](int size) {
        const int k = factorOf(size);
        return std::vector<int>(static_cast<size_t>(k), size / k);
    });
}

} // namespace mural::compositor
