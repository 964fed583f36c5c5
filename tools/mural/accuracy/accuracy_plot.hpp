// What was measured as a picture: for each line its largest and its usual error on one logarithmic scale, and nothing at its left end.
#pragma once

#include <string>

#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

[[nodiscard]] std::string plotOf(const AccuracyReport& report); // SVG

} // namespace mural::cli
