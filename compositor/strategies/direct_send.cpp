// Direct send: rank b composites band b of n, which all others send to it at once; then the bands go to the collector.
// Two steps for any n, and n (n-1) small pieces. Source: Hsu, "Segmented ray casting for data parallel volume
// rendering" (1993); thesis, "DB with direct send".
#include <cstdlib>

#include "compositor/strategies/schedule_maker.hpp"

namespace mural::compositor {

void makeDirectSend(ScheduleMaker& maker) {
    const int n = maker.ranks();
    std::vector<RowTransfer> swap, gather;
    // Each rank begins with its neighbour, so the first receiver differs per rank.
    for (int offset = 1; offset < n; ++offset)
        for (int from = 0; from < n; ++from) {
            const int to = (from + offset) % n;
            swap.push_back({from, to, maker.band(to, n), from < to ? Step::Kind::FoldEarlier : Step::Kind::FoldLater,
                            std::abs(from - to)});
        }
    for (int rank = 1; rank < n; ++rank) gather.push_back({rank, 0, maker.band(rank, n), Step::Kind::Place, rank});
    maker.round(swap);
    maker.round(gather);
}

} // namespace mural::compositor
