// Measures decompositions of a user's program: each frame is compared with the program's own context.
#pragma once

#include "tools/mural/accuracy/accuracy_row.hpp"
#include "tools/mural/accuracy/accuracy_runs.hpp"

namespace mural::cli {

// frames: number of compared frames. Decompositions that change the picture on purpose (eyes, samples) have no such
// reference.
void measureProgram(const AccuracyRuns& runs, const Words& program, int64_t frames, bool quick,
                    std::vector<AccuracyRow>& rows);

} // namespace mural::cli
