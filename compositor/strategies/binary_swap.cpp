// Binary swap: neighbouring pairs swap halves of their pictures, then pairs of pairs quarters, and so on. Each rank
// transfers less than one picture, in log2(n) steps. The largest power of two of n ranks swaps; the rest is composited
// into neighbours first. Source: Ma, Painter, Hansen, Krogh, "Parallel volume rendering using binary-swap compositing"
// (1994).
#include <bit>

#include "compositor/strategies/swap_groups.hpp"

namespace mural::compositor {

void makeBinarySwap(ScheduleMaker& maker) {
    const auto swapping = static_cast<int>(std::bit_floor(static_cast<unsigned>(maker.ranks())));
    swapGroups(maker, foldRemainder(maker, swapping), [](int size) { return std::vector<int>(2, size / 2); });
}

} // namespace mural::compositor
