#include "balancer/equalizers/cost_map/change_watch.hpp"

#include <algorithm>
#include <cmath>

namespace mural::balance {

namespace {

constexpr double kLeastNoise = .003, kMostNoise = .25;
// A sum grows by the deviation of a time from its mean, in standard deviations, less the slack. Noise alone reaches
// these limits once in some 10^4 frames of 64 parts; the second pair finds slow drifts.
constexpr double kSlack = 1, kLimit = 8;
constexpr double kSlowSlack = .5, kSlowLimit = 16;
constexpr double kMeanDeviations = 2; // error of a mean of one frame
constexpr double kMostDeviation = 15; // of one frame: a single outlier is a change, but not a lasting one

} // namespace

bool ChangeWatch::add(const std::vector<double>& seconds) {
    if (seconds.size() != mean_.size()) frames_ = 0;
    logs_.resize(seconds.size());
    double common = 0;
    for (size_t i = 0; i < seconds.size(); ++i) common += logs_[i] = std::log(std::max(seconds[i], 1e-9));
    common /= static_cast<double>(std::max<size_t>(1, seconds.size()));
    for (double& log : logs_) log -= common;
    if (frames_ == 0) {
        mean_ = last_ = logs_;
        for (auto* sums : {&above_, &below_, &slowAbove_, &slowBelow_}) sums->assign(logs_.size(), 0);
        frames_ = 1;
        return false;
    }
    if (frames_ >= 2) estimateNoise(logs_);
    const bool isChanged = sumDeviations();
    const double weight = 1. / std::min(frames_ + 1, 64);
    for (size_t i = 0; i < logs_.size(); ++i) mean_[i] += weight * (logs_[i] - mean_[i]);
    last2_ = last_;
    last_ = logs_;
    ++frames_;
    return isChanged;
}

bool ChangeWatch::sumDeviations() {
    const double uncertain = kMeanDeviations / std::sqrt(frames_); // of the mean itself
    bool isChanged = false;
    for (size_t i = 0; i < logs_.size(); ++i) {
        const double z = std::clamp((logs_[i] - mean_[i]) / noise(), -kMostDeviation, kMostDeviation);
        above_[i] = std::max(0., above_[i] + z - uncertain - kSlack);
        below_[i] = std::max(0., below_[i] - z - uncertain - kSlack);
        slowAbove_[i] = std::max(0., slowAbove_[i] + z - uncertain - kSlowSlack);
        slowBelow_[i] = std::max(0., slowBelow_[i] - z - uncertain - kSlowSlack);
        isChanged |= std::max(above_[i], below_[i]) > kLimit || std::max(slowAbove_[i], slowBelow_[i]) > kSlowLimit;
    }
    return isChanged;
}

// Second differences contain no slow drift; their variance is six times that of the noise.
void ChangeWatch::estimateNoise(const std::vector<double>& logs) {
    double sum = 0;
    for (size_t i = 0; i < logs.size(); ++i) {
        const double most = 4 * std::sqrt(6) * noise_; // a change of the load is no noise
        const double second = std::clamp(logs[i] - 2 * last_[i] + last2_[i], -most, most);
        sum += second * second;
    }
    const double variance = sum / (6 * static_cast<double>(logs.size()));
    const auto count = static_cast<double>(logs.size());
    const double weight = std::max(1. / 16, count / (samples_ + count));
    samples_ += count;
    noise_ = std::sqrt((1 - weight) * noise_ * noise_ + weight * variance);
    noise_ = std::clamp(noise_, kLeastNoise, kMostNoise);
}

} // namespace mural::balance
