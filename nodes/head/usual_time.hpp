// What something that comes again usually takes. Times by the clock on the wall have in them what others did meanwhile: where all cores are
// busy, one of them is a thousand times too long now and then, and would stand for all that are not measured until the next one.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace mural {

class UsualTime {
public:
    void add(double value) {
        last_[count_++ % kKept] = value;
        const size_t there = std::min(count_, kKept);
        std::array<double, kKept> sorted = last_;
        const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((there - 1) / 2); // of two the shorter one
        std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(there));
        usual_ = *middle;
    }
    // The median of the last few; 0 before the first.
    [[nodiscard]] double value() const { return usual_; }
    // There are so many that one which was disturbed is not the median.
    [[nodiscard]] bool isKnown() const { return count_ >= 3; }

private:
    static constexpr size_t kKept = 5;
    std::array<double, kKept> last_{};
    size_t count_ = 0;
    double usual_ = 0;
};

// The same by how many bytes it is done for, each size up to twice the one before: short ones take many times as long for each byte as long ones.
class UsualTimesBySize {
public:
    [[nodiscard]] UsualTime& of(size_t sizeBytes) { return bySize_[std::min<size_t>(std::bit_width(sizeBytes), kSizes - 1)]; }

private:
    static constexpr size_t kSizes = 32;
    std::array<UsualTime, kSizes> bySize_{};
};

} // namespace mural
