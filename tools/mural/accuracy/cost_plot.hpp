// Below the errors: what they cost, as two plots of CPU time and of bytes against the error.
#pragma once

#include "balancer/drawing/svg.hpp"
#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

// Where its lower end is; nothing is drawn without rows that know their cost.
double drawCosts(drawing::Svg& svg, const AccuracyReport& report, const drawing::Box& area);

} // namespace mural::cli
