// Serial: the collector receives all pictures whole, one after the other. One step, and nothing is transferred twice,
// but the collector's link and compositing handle n-1 pictures.
#include "compositor/strategies/schedule_maker.hpp"

namespace mural::compositor {

void makeSerial(ScheduleMaker& maker) {
    std::vector<RowTransfer> all;
    for (int rank = 1; rank < maker.ranks(); ++rank)
        all.push_back({rank, 0, maker.band(0, 1), Step::Kind::FoldLater, rank});
    maker.round(all);
}

} // namespace mural::compositor
