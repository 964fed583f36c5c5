// Sample positions within a pixel. Source: thesis, "Subpixel Compounds".
#pragma once

#include "common/geometry/sub_pixel.hpp"

namespace mural {

struct Jitter {
    double x = 0; // in pixels to the right of the centre, between -0.5 and 0.5
    double y = 0;
};

// Returns the position of one sample. Each coordinate takes each of n evenly spaced values once. The mean of the
// samples is therefore the pixel's centre, and n samples have n different distances from every edge. Columns are in
// order, rows in the order of their radical inverses (0, 1/2, 1/4, 3/4, ...): a Hammersley set.
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
