// Measures pixel positions of parts in float and double: compares a synthetic picture in parts with the whole in higher
// precision.
#pragma once

#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

void measureTransforms(std::vector<AccuracyRow>& rows);

} // namespace mural::cli
