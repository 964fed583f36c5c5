// Radix-k: n is a product of factors up to eight; in each round groups of so many swap, each with all others at once. Fewer rounds
// than binary swap, fewer pieces at a time than direct send. Of numbers with larger prime factors, the largest one below that has
// none swaps, and the rest is folded into neighbours first.
// Source: Peterka, Goodell, Ross, Shen, Thakur, "A configurable algorithm for parallel image-compositing applications" (2009).
#include "compositor/strategies/swap_groups.hpp"

namespace mural::compositor {

namespace {

constexpr int kLargestFactor = 8;

// The largest factor in a round; 1: there is none but 1.
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
    while (!factors(swapping)) --swapping; // a power of two at the latest: more than half of the ranks
    swapGroups(maker, foldRemainder(maker, swapping), [](int size) {
        const int k = factorOf(size);
        return std::vector<int>(static_cast<size_t>(k), size / k);
    });
}

} // namespace mural::compositor
