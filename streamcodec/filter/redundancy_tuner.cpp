#include "streamcodec/filter/redundancy_tuner.hpp"

#include <algorithm>

namespace mural::filter {
namespace {

// Least size of relevant frames, absolute and relative to the program's bytes. Smaller frames have nothing to gain, and
// a trial breaks equal runs.
constexpr uint64_t kMinWireBytes = 200, kMinPart = 100;
constexpr double kHopelessCost = 1.1;
constexpr double kClearly = 0.97; // cost ratio that counts as cheaper; otherwise the filter stays on

template <size_t N> double median(std::array<double, N> values) {
    std::ranges::nth_element(values, values.begin() + N / 2);
    return values[N / 2];
}

} // namespace

bool RedundancyTuner::wantsTime() const { return phase_ == Phase::Before || phase_ == Phase::Trying; }

void RedundancyTuner::next(Phase phase) {
    phase_ = phase;
    frames_ = 0;
    large_ = 0;
}

void RedundancyTuner::frame(uint64_t programBytes, uint64_t wireBytes, double costNs) {
    if (programBytes == 0) return;
    if (wantsTime() && costNs < 0) return; // begun before timing was requested
    if (wantsTime()) costs_[phase_ == Phase::Trying][frames_] = costNs / static_cast<double>(programBytes);
    ++frames_;
    switch (phase_) {
    case Phase::Waiting:
        // a few loading frames do not count
        large_ += wireBytes >= std::max(kMinWireBytes, programBytes / kMinPart);
        if (frames_ < until_) return;
        return next(drops_ || large_ * 2 >= frames_ ? Phase::Before : Phase::Waiting);
    case Phase::Before:
        if (frames_ < kCompared) return;
        drops_ = !drops_;
        return next(Phase::Settling);
    case Phase::Settling:
        if (frames_ >= kSettling) next(Phase::Trying);
        return;
    case Phase::Trying:
        if (frames_ >= kCompared || hopeless()) decide();
    }
}

void RedundancyTuner::disturbed() {
    if (phase_ == Phase::Settling || phase_ == Phase::Trying) drops_ = !drops_;
    next(Phase::Waiting);
}

bool RedundancyTuner::hopeless() const {
    const double maximum = median(costs_[0]) * kHopelessCost;
    return frames_ >= kHopeless && std::all_of(costs_[1].begin(), costs_[1].begin() + frames_,
                                               [maximum](double cost) { return cost > maximum; });
}

void RedundancyTuner::decide() {
    const double before = median(costs_[0]), tried = median(costs_[1]);
    const bool better = frames_ >= kCompared && (drops_ ? tried * kClearly <= before : tried <= before * kClearly);
    if (!better) drops_ = !drops_;
    until_ = better ? kAfterChange : std::min(until_ * 2, kMaxBetween);
    next(Phase::Waiting);
}

} // namespace mural::filter
