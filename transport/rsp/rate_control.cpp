#include "transport/rsp/rate_control.hpp"

#include <algorithm>
#include <cmath>

namespace mural::rsp {

namespace {
constexpr double kLossNoticed = 0.005;  // below this share nothing is asked
constexpr double kCrowded = 0.02;       // above the floor
constexpr double kMostDecrease = 0.2;   // at once
constexpr double kIncrease = 5.0 / 1000; // of the highest rate, per round
constexpr double kBucketS = 0.001;
constexpr double kLeastBucketBytes = 48 * 1024.0; // one batch
} // namespace

RateControl::RateControl(const RateSettings& settings)
    : most_(settings.mostBytesPerS), least_(most_ * settings.leastShare), rate_(most_) {}

int64_t RateControl::roundNs(int64_t roundTripNs) { return std::max<int64_t>(50'000'000, 4 * roundTripNs); }

double RateControl::bytesPerS() const { return trialRoundsLeft_ > 0 ? rate_ * kTrialRate : rate_; }

void RateControl::decideAfterTrial(double lostShare, int64_t nowNs) {
    floor_ = std::min(lostShare, 0.5);
    nextTrialNs_ = nowNs + kBetweenTrialsNs;
}

void RateControl::roundEnded(double lostShare, int64_t nowNs) {
    if (most_ <= 0) return;
    if (trialRoundsLeft_ > 0) {
        if (--trialRoundsLeft_ == 0) decideAfterTrial(lostShare, nowNs);
        return;
    }
    floor_ = std::min(floor_, lostShare);
    const double crowding = lostShare - floor_;
    if (lostShare > kLossNoticed && nowNs >= nextTrialNs_ && crowding < kMostDecrease) {
        trialRoundsLeft_ = kTrialRounds;
        return;
    }
    if (crowding > kCrowded)
        rate_ = std::max(least_, rate_ * (1 - std::min(crowding, kMostDecrease)));
    else
        rate_ = std::min(most_, rate_ + kIncrease * most_);
}

void RateControl::refill(int64_t nowNs) {
    const double depth = std::max(kLeastBucketBytes, most_ * kBucketS);
    if (refilledNs_ == INT64_MIN) {
        tokens_ = depth;
    } else if (nowNs > refilledNs_) {
        tokens_ = std::min(depth, tokens_ + bytesPerS() * static_cast<double>(nowNs - refilledNs_) * 1e-9);
    }
    refilledNs_ = std::max(refilledNs_, nowNs);
}

bool RateControl::take(double bytes, int64_t nowNs) {
    if (most_ <= 0) return true;
    refill(nowNs);
    if (tokens_ < bytes) return false;
    tokens_ -= bytes;
    return true;
}

int64_t RateControl::whenNs(double bytes, int64_t nowNs) const {
    if (most_ <= 0 || tokens_ >= bytes) return nowNs;
    const double waitNs = std::ceil((bytes - tokens_) / bytesPerS() * 1e9);
    return std::max(nowNs, refilledNs_) + static_cast<int64_t>(waitNs);
}

} // namespace mural::rsp
