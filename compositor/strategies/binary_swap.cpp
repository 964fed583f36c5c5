// Binary swap: pairs of neighbours swap halves of what they hold, then pairs of pairs quarters, and so on. Each carries less than
// one picture, in log2(n) steps. Of n nodes the largest power of two swaps; the rest is folded into neighbours first.
// Source: Ma, Painter, Hansen, Krogh, "Parallel volume rendering using binary-swap compositing" (1994).
#include <bit>

#include "compositor/strategies/swap_groups.hpp"

namespace mural::compositor {

void makeBinarySwap(ScheduleMaker& maker) {
    const auto swapping = static_cast<int>(std::bit_floor(static_cast<unsigned>(maker.ranks())));
    swapGroups(maker, foldRemainder(maker, swapping), [](int size) { return std::vector<int>(2, size / 2); });
}

} // namespace mural::compositor
