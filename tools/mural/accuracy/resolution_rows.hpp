// Measures dynamic frame resolution: error and time of each zoom while a scene moves, and the error when it stands
// still.
#pragma once

#include "tools/mural/accuracy/accuracy_row.hpp"
#include "tools/mural/accuracy/accuracy_runs.hpp"

namespace mural::cli {

void measureResolutions(const AccuracyRuns& runs, bool quick, std::vector<AccuracyRow>& rows);

} // namespace mural::cli
