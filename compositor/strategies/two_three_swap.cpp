// 2-3 swap: binary swap with groups of two and three, so any number of ranks takes part from the first step on. Unlike
// in the paper, merged groups may differ in size at any level: bands of a smaller group are cut at the boundaries of
// the others. Source: Yu, Wang, Ma, "Massively parallel volume rendering using 2-3 swap image compositing" (2008).
#include "compositor/strategies/swap_groups.hpp"

#include <numeric>
#include <vector>

namespace mural::compositor {

void makeTwoThreeSwap(ScheduleMaker& maker) {
    std::vector<int> all(static_cast<size_t>(maker.ranks()));
    std::iota(all.begin(), all.end(), 0);
    swapGroups(maker, all, [](int size) -> std::vector<int> {
        if (size % 2 == 0) return {size / 2, size / 2};
        if (size % 3 == 0) return {size / 3, size / 3, size / 3};
        return {(size + 1) / 2, size / 2};
    });
}

} // namespace mural::compositor
