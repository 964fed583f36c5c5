// The matrix of glFrustum.
#pragma once

#include <array>

namespace mural::test {

// Returns the matrix column by column.
inline std::array<double, 16> frustumMatrix(double l, double r, double b, double t, double n, double f) {
    return {2 * n / (r - l),
            0,
            0,
            0,
            0,
            2 * n / (t - b),
            0,
            0,
            (r + l) / (r - l),
            (t + b) / (t - b),
            -(f + n) / (f - n),
            -1,
            0,
            0,
            -2 * f * n / (f - n),
            0};
}

} // namespace mural::test
