// Common part of swap strategies: groups of ranks, each holding a picture in bands, are merged into larger groups until
// one remains; then the bands go to the collector.
#pragma once

#include <functional>
#include <vector>

#include "compositor/strategies/schedule_maker.hpp"

namespace mural::compositor {

// Returns the sizes of the groups into which a group of `size` ranks (two or more) is divided.
using GroupSplit = std::function<std::vector<int>(int size)>;

// ranks: in draw order; the first is the collector.
void swapGroups(ScheduleMaker& maker, const std::vector<int>& ranks, const GroupSplit& split);

// Composites the pictures of all ranks into `count` ranks, by merging pairs of neighbours; returns the remaining ranks.
// Requires `count` to be at least half of the ranks.
[[nodiscard]] std::vector<int> foldRemainder(ScheduleMaker& maker, int count);

} // namespace mural::compositor
