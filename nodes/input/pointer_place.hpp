// Places of the pointer and steps of the wheel. Pure.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace mural::input {

// Returns the pixel at a fraction of a side with that number of pixels.
[[nodiscard]] inline int pixelAt(double fraction, int pixels) {
    return std::clamp(static_cast<int>(std::floor(fraction * pixels)), 0, std::max(pixels - 1, 0));
}

// Adds a turn of the wheel, in 1/120 of a step, to the rest of earlier ones. Returns the whole steps: -1 or 1 each.
[[nodiscard]] inline std::vector<int> wheelSteps(double& rest, double add) {
    constexpr double kStep = 120;
    constexpr int kMostSteps = 20; // of one event
    if (rest * add < 0) rest = 0;  // the direction changes
    rest += add;
    const int whole = std::clamp(static_cast<int>(rest / kStep), -kMostSteps, kMostSteps);
    rest = std::fmod(rest, kStep);
    return std::vector<int>(static_cast<size_t>(std::abs(whole)), whole < 0 ? -1 : 1);
}

} // namespace mural::input
