#include "nodes/head/statistics/node_clock.hpp"

#include <algorithm>

namespace mural {

NodeClock NodeClock::shared() {
    NodeClock clock;
    clock.isShared_ = true;
    clock.errorNs_ = 0;
    return clock;
}

// A round trip that is nearly as short as the best one replaces it, because it is newer.
void NodeClock::addRoundTrip(const ClockSample& sample) {
    if (isShared_) return;
    ClockOffset trip;
    trip.add(sample);
    if (trip.errorNs() == INT64_MAX || (isKnown() && trip.errorNs() > errorNs_ + errorNs_ / 4)) return;
    offsetNs_ = trip.offsetNs();
    errorNs_ = trip.errorNs();
    baseNs_ = sample.cameBackNs - sample.leftThereNs;
    messages_ = 0;
}

void NodeClock::addMessage(int64_t leftThereNs, int64_t arrivedNs) {
    if (isShared_) return;
    waysNs_[messages_++ % kMessages] = arrivedNs - leftThereNs;
}

// A clock that is fast by d makes the ways appear shorter by d.
int64_t NodeClock::driftNs() const {
    if (messages_ < kMessages || baseNs_ == INT64_MAX) return 0;
    return baseNs_ - *std::ranges::min_element(waysNs_);
}

} // namespace mural
