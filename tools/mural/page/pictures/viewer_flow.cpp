#include "tools/mural/page/pictures/viewer_flow.hpp"

namespace mural::page {

void ViewerFlow::sent(uint64_t frame, int64_t nowNs) { inFlight_.push_back({frame, nowNs}); }

void ViewerFlow::acknowledged(uint64_t frame, int64_t nowNs) {
    bool hasAny = false;
    int64_t tripNs = 0;
    while (!inFlight_.empty() && inFlight_.front().frame <= frame) {
        tripNs = nowNs - inFlight_.front().atNs;
        hasAny = true;
        inFlight_.pop_front();
    }
    if (!hasAny) return;
    roundTripNs_ = roundTripNs_ == 0 ? tripNs : (roundTripNs_ * 3 + tripNs) / 4;
    const int64_t sinceNs = nowNs - changedNs_;
    if (tripNs > kLateNs && sinceNs > kDownAfterNs && step_ + 1 < kQualities.size()) {
        ++step_;
        changedNs_ = nowNs;
    } else if (tripNs < kInTimeNs && roundTripNs_ < kInTimeNs && sinceNs > kUpAfterNs && step_ > 0) {
        --step_;
        changedNs_ = nowNs;
    }
}

void ViewerFlow::reset() { inFlight_.clear(); }

} // namespace mural::page
