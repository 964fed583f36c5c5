#include "transport/rsp/protocol/rate_control.hpp"

#include <algorithm>
#include <cmath>

namespace mural::rsp {

namespace {
constexpr double kCrowded = 0.02; // loss above the floor that counts as congestion; less is repaired without a reaction
constexpr double kMinFloor = 0.005;           // floor below which losses count as random
constexpr double kMaxDecrease = 0.2;          // largest single decrease
constexpr double kIncreasePerS = 0.1;         // of the maximum rate
constexpr int64_t kMaxRiseNs = 1'000'000'000; // longest time that one round's increase covers
constexpr double kFloorFalls = 1.0 / 8;       // of the difference, per round with fewer losses
constexpr double kChance = 3.0;               // in standard deviations
// Bucket size: what a process catches up after a scheduling gap. Queues on the path hold more.
constexpr double kBucketS = 0.005;
constexpr double kMinBucketBytes = 48 * 1024.0;
constexpr double kMaxBucketBytes = 384 * 1024.0;
constexpr double kBatchS = 0.001;
} // namespace

RateControl::RateControl(const RateSettings& settings)
    : max_(settings.maxBytesPerS),
      min_(max_ * settings.minShare),
      rate_(max_),
      depth_(std::clamp(max_ * kBucketS, kMinBucketBytes, kMaxBucketBytes)) {}

int64_t RateControl::roundNs(int64_t roundTripNs) { return std::max<int64_t>(50'000'000, 4 * roundTripNs); }

double RateControl::bytesPerS() const { return trialRoundsLeft_ > 0 ? rate_ * kTrialRate : rate_; }

void RateControl::decideAfterTrial(double lostShare, int64_t nowNs) {
    floor_ = std::min(lostShare, 0.5);
    nextTrialNs_ = nowNs + kBetweenTrialsNs;
}

void RateControl::rise(int64_t elapsedNs) {
    const double elapsedS = static_cast<double>(std::min(elapsedNs, kMaxRiseNs)) * 1e-9;
    rate_ = std::min(max_, rate_ + kIncreasePerS * max_ * elapsedS);
}

void RateControl::roundEnded(double lostShare, int64_t datagrams, int64_t nowNs) {
    if (max_ <= 0 || datagrams <= 0) return;
    const int64_t elapsedNs = roundNs_ == INT64_MIN ? 0 : nowNs - roundNs_;
    roundNs_ = nowNs;
    if (trialRoundsLeft_ > 0) {
        if (--trialRoundsLeft_ == 0) decideAfterTrial(lostShare, nowNs);
        return;
    }
    if (lostShare < floor_) floor_ += (lostShare - floor_) * kFloorFalls;
    const double crowding = lostShare - floor_;
    const double chance = kChance * std::sqrt(std::max(floor_, kMinFloor) / static_cast<double>(datagrams));
    if (lostShare > kCrowded && nowNs >= nextTrialNs_ && crowding < kMaxDecrease) {
        trialRoundsLeft_ = kTrialRounds;
        return;
    }
    if (crowding > kCrowded + chance)
        rate_ = std::max(min_, rate_ * (1 - std::min(crowding, kMaxDecrease)));
    else
        rise(elapsedNs);
}

void RateControl::refill(int64_t nowNs) {
    if (refilledNs_ == INT64_MIN) {
        tokens_ = depth_;
    } else if (nowNs > refilledNs_) {
        tokens_ = std::min(depth_, tokens_ + bytesPerS() * static_cast<double>(nowNs - refilledNs_) * 1e-9);
    }
    refilledNs_ = std::max(refilledNs_, nowNs);
}

bool RateControl::take(double bytes, int64_t nowNs) {
    if (max_ <= 0) return true;
    refill(nowNs);
    if (tokens_ < bytes) return false;
    tokens_ -= bytes;
    return true;
}

bool RateControl::has(double bytes, int64_t nowNs) {
    if (max_ <= 0) return true;
    refill(nowNs);
    return tokens_ >= std::min(bytes, depth_);
}

double RateControl::batchBytes() const { return bytesPerS() * kBatchS; }

int64_t RateControl::whenNs(double bytes, int64_t nowNs) const {
    if (max_ <= 0 || tokens_ >= bytes) return nowNs;
    const double waitNs = std::ceil((bytes - tokens_) / bytesPerS() * 1e9);
    return std::max(nowNs, refilledNs_) + static_cast<int64_t>(waitNs);
}

} // namespace mural::rsp
