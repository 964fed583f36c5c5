// Watches the times of parts that stay as they are: estimates their noise and detects changes of the load by cumulative
// sums (E. S. Page, Continuous inspection schemes, 1954). Only the distribution counts; a common factor of all times is
// no change.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace mural::balance {

class ChangeWatch {
public:
    // Begins a new reference; the noise estimate stays.
    void restart() { frames_ = 0; }
    // Adds the times of one frame. Returns true if they differ from the reference by more than noise.
    bool add(const std::vector<double>& seconds);

    // Standard deviation of a time relative to its mean.
    [[nodiscard]] double noise() const { return samples_ < kSureSamples ? std::max(noise_, kInitialNoise) : noise_; }
    [[nodiscard]] bool isNoiseKnown() const { return samples_ > kInitialSamples; }
    [[nodiscard]] int frames() const { return frames_; } // frames of the reference

private:
    void estimateNoise(const std::vector<double>& logs);
    bool sumDeviations();

    int frames_ = 0;
    std::vector<double> mean_;          // of the logarithms of the times
    std::vector<double> above_, below_; // cumulative sums of deviations
    std::vector<double> slowAbove_, slowBelow_;
    std::vector<double> logs_, last_, last2_; // logarithms of this frame and of the two before
    static constexpr double kInitialNoise = .03;
    static constexpr double kSureSamples = 100; // fewer can show too little noise by chance
    double noise_ = kInitialNoise;
    static constexpr double kInitialSamples = 4; // weight of the initial estimate
    double samples_ = kInitialSamples;
};

} // namespace mural::balance
