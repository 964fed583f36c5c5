// Where in a pixel its samples lie.
#pragma once

#include <cmath>
#include <numeric>

#include "balancer/compound/render_context.hpp"
#include "common/sub_pixel.hpp"

namespace mural::compound {

// A rank-1 lattice: both coordinates take each of n evenly spaced values once, so that the samples' mean is the pixel's
// middle for any n, and n samples see n different distances from every edge.
[[nodiscard]] inline Jitter jitterOf(const SubPixel& s) {
    if (s.size <= 1) return {};
    constexpr double kGoldenRatio = 0.61803398874989485;
    auto step = static_cast<int64_t>(std::lround(s.size * kGoldenRatio));
    while (std::gcd(step, static_cast<int64_t>(s.size)) != 1) ++step;
    const auto place = [&](int64_t i) { return (static_cast<double>(i) + .5) / s.size - .5; };
    return {place(s.index), place(s.index * step % s.size)};
}

} // namespace mural::compound
