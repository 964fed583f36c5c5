// Clip coordinates of a draw as linear functions of its vertex attributes, with bounds on the rounding of the driver.
//
// A driver computes in 32 bits, in any order, with or without fused operations. Each coefficient therefore has an
// error: two units in the last place for each operation, of the magnitudes that enter. Source:
// docs/architecture/culling.md.
#pragma once

#include <array>
#include <cstddef>

namespace mural::culling {

// Attribute components that one linear function may read.
inline constexpr size_t kMaxInputs = 8;

// Rounding of one operation in 32 bits, relative to the magnitudes of its operands.
inline constexpr double kRounding = 2.4e-7;

// constant + sum of factor[i] * input[i]. The driver's result differs by at most constantError + sum of error[i] *
// |input[i]|.
struct LinearForm {
    std::array<double, kMaxInputs> factor{}, error{};
    double constant = 0, constantError = 0;

    [[nodiscard]] bool isConstant() const;
};

// The clip coordinates that decide a position on screen.
struct LinearView {
    size_t inputs = 0;
    LinearForm x, y, w;
};

// The view of fixed function: inputs are the `components` (2 to 4) of the vertex position. Matrices are column-major.
[[nodiscard]] LinearView fixedFunctionView(const float (&projection)[16], const float (&modelview)[16],
                                           size_t components);

} // namespace mural::culling
