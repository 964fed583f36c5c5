#include "transport/rsp/protocol/loss_detector.hpp"

#include <algorithm>

namespace mural::rsp {

void LossDetector::arrived(Sequence s, int64_t nowNs) {
    if (s < highest_) return;
    if (s > highest_) gaps_.push_back({s, nowNs});
    highest_ = s + 1;
}

void LossDetector::onLateArrival(int64_t lateNs) {
    latenessNs_ = std::min(kMaxLatenessNs, std::max(latenessNs_, lateNs + lateNs / 4));
}

void LossDetector::polled(Sequence next) {
    if (next < lostBefore_) return; // outdated
    highest_ = later(highest_, next);
    lostBefore_ = next;
    while (!gaps_.empty() && gaps_.front().end <= next) gaps_.pop_front();
}

bool LossDetector::expire(int64_t nowNs) {
    bool any = false;
    while (!gaps_.empty() && highest_ - gaps_.front().end >= kLater && nowNs - gaps_.front().noticedNs >= latenessNs_) {
        lostBefore_ = later(lostBefore_, gaps_.front().end);
        gaps_.pop_front();
        // The observed lateness decays.
        latenessNs_ -= latenessNs_ / 256;
        any = true;
    }
    return any;
}

int64_t LossDetector::whenNs() const {
    if (gaps_.empty() || highest_ - gaps_.front().end < kLater) return INT64_MAX;
    return gaps_.front().noticedNs + latenessNs_;
}

} // namespace mural::rsp
