// Plots costs below the errors: CPU time and bytes against the error.
#pragma once

#include "balancer/svg/svg.hpp"
#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

// Returns the lower end of the plots; draws nothing without rows with costs.
double drawCosts(drawing::Svg& svg, const AccuracyReport& report, const drawing::Box& area);

} // namespace mural::cli
