// Where a part's pixels are looked up, by floats and by doubles: a made-up picture in parts, against the whole in wider numbers.
#pragma once

#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

void measureTransforms(std::vector<AccuracyRow>& rows);

} // namespace mural::cli
