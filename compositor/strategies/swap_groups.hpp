// What all swaps have in common: groups of ranks that each hold a whole picture, divided into bands among their members, are
// merged to larger ones, until there is one; then the bands go to the collector.
#pragma once

#include <functional>
#include <vector>

#include "compositor/strategies/schedule_maker.hpp"

namespace mural::compositor {

// Into how many groups, and how large, a group of `size` ranks (two or more) is divided.
using GroupSplit = std::function<std::vector<int>(int size)>;

// ranks: in draw order, the first is the collector.
void swapGroups(ScheduleMaker& maker, const std::vector<int>& ranks, const GroupSplit& split);

// Folds the pictures of all ranks into those of `count` ranks, pairs of neighbours as far as is needed; returns who is left.
// count: at least half of the ranks.
[[nodiscard]] std::vector<int> foldRemainder(ScheduleMaker& maker, int count);

} // namespace mural::compositor
