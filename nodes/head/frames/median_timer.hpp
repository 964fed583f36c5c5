// The typical duration of a repeated operation. Wall-clock samples include preemption: on a busy machine a rare sample
// is a thousand times too long, and must not stand for the unmeasured ones.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace mural {

class MedianTimer {
public:
    void add(double value) {
        last_[count_++ % kSamples] = value;
        const size_t there = std::min(count_, kSamples);
        std::array<double, kSamples> sorted = last_;
        const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((there - 1) / 2); // the lower median
        std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(there));
        median_ = *middle;
    }
    // The median of the last samples; 0 before the first.
    [[nodiscard]] double value() const { return median_; }
    // True with enough samples that one outlier is not the median.
    [[nodiscard]] bool isKnown() const { return count_ >= 3; }

private:
    static constexpr size_t kSamples = 5;
    std::array<double, kSamples> last_{};
    size_t count_ = 0;
    double median_ = 0;
};

// Typical durations per size class of a factor of two, because short operations cost many times more per byte than long
// ones.
class MedianTimersBySize {
public:
    [[nodiscard]] MedianTimer& of(size_t sizeBytes) {
        return bySize_[std::min<size_t>(std::bit_width(sizeBytes), kSizes - 1)];
    }

private:
    static constexpr size_t kSizes = 32;
    std::array<MedianTimer, kSizes> bySize_{};
};

} // namespace mural
