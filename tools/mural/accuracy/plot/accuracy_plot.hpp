// Plots the measurements: per row its largest and its mean error on one logarithmic scale, with exact results at the
// left end.
#pragma once

#include <string>

#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

[[nodiscard]] std::string plotOf(const AccuracyReport& report); // returns SVG

} // namespace mural::cli
