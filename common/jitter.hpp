// Where in a pixel its samples lie. Source: thesis, "Subpixel Compounds".
#pragma once

#include "common/sub_pixel.hpp"

namespace mural {

struct Jitter {
    double x = 0; // pixels to the right of the middle, between -0.5 and 0.5
    double y = 0;
};

// Both coordinates take each of n evenly spaced values once, so that the samples' mean is the pixel's middle for any n, and
// n samples see n different distances from every edge: columns in order, rows in that of their radical inverses
// (0, 1/2, 1/4, 3/4, …), a Hammersley set.
[[nodiscard]] inline Jitter jitterOf(const SubPixel& s) {
    if (s.size <= 1) return {};
    const auto radicalInverse = [](int32_t i) {
        double value = 0, digit = 0.5;
        for (; i > 0; i /= 2, digit /= 2) value += i % 2 * digit;
        return value;
    };
    int32_t row = 0;
    for (int32_t i = 0; i < s.size; ++i) row += radicalInverse(i) < radicalInverse(s.index);
    const auto place = [&](int32_t i) { return (i + .5) / s.size - .5; };
    return {place(s.index), place(row)};
}

} // namespace mural
