#include "nodes/swap_barrier/clock_offset.hpp"

#include <algorithm>

namespace mural {

void ClockOffset::add(const ClockSample& s) {
    const int64_t wayNs = (s.cameBackNs - s.sentNs) - (s.leftThereNs - s.arrivedThereNs);
    if (wayNs < 0) return; // a clock was set, or the peer is wrong
    seen_[next_] = {((s.arrivedThereNs - s.sentNs) + (s.leftThereNs - s.cameBackNs)) / 2, wayNs};
    next_ = (next_ + 1) % kSamples;
    best_ = *std::ranges::min_element(seen_, {}, &Seen::wayNs);
}

} // namespace mural
