#include "balancer/equalizers/cost_map/change_watch.hpp"

#include <algorithm>
#include <cmath>

namespace mural::balance {

namespace {

constexpr double kLeastNoise = .003, kMostNoise = .25;
constexpr double kChangedDeviations = 5; // of one part; noise alone reaches it once in 10^6 times

} // namespace

bool ChangeWatch::add(const std::vector<double>& seconds) {
    if (seconds.size() != mean_.size()) frames_ = 0;
    logs_.resize(seconds.size());
    double common = 0;
    for (size_t i = 0; i < seconds.size(); ++i) common += logs_[i] = std::log(std::max(seconds[i], 1e-9));
    common /= static_cast<double>(std::max<size_t>(1, seconds.size()));
    for (double& log : logs_) log -= common;
    if (frames_ == 0) {
        mean_ = logs_;
        last_ = logs_;
        frames_ = 1;
        return false;
    }
    const double deviation = noise_ * std::sqrt(1 + 1. / frames_);
    double farthest = 0;
    for (size_t i = 0; i < logs_.size(); ++i) farthest = std::max(farthest, std::abs(logs_[i] - mean_[i]));
    const bool isChanged = farthest > kChangedDeviations * deviation;
    if (!isChanged) {
        if (frames_ >= 2) estimateNoise(logs_);
        const double weight = 1. / std::min(frames_ + 1, 64);
        for (size_t i = 0; i < logs_.size(); ++i) mean_[i] += weight * (logs_[i] - mean_[i]);
    }
    last2_ = last_;
    last_ = logs_;
    ++frames_;
    return isChanged;
}

// Second differences contain no slow drift; their variance is six times that of the noise.
void ChangeWatch::estimateNoise(const std::vector<double>& logs) {
    double sum = 0;
    for (size_t i = 0; i < logs.size(); ++i) {
        const double second = logs[i] - 2 * last_[i] + last2_[i];
        sum += second * second;
    }
    const double variance = sum / (6 * static_cast<double>(logs.size()));
    noiseFrames_ = std::min(noiseFrames_ + 1, 16);
    const double weight = std::max(1. / 16, .5 / noiseFrames_);
    noise_ = std::sqrt((1 - weight) * noise_ * noise_ + weight * variance);
    noise_ = std::clamp(noise_, kLeastNoise, kMostNoise);
}

} // namespace mural::balance
