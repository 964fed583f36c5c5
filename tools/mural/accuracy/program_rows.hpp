// Decompositions of a program that the user names: each frame against what the program's own context has drawn meanwhile.
#pragma once

#include "tools/mural/accuracy/accuracy_row.hpp"
#include "tools/mural/accuracy/accuracy_runs.hpp"

namespace mural::cli {

// frames: how many are compared. What a decomposition changes on purpose (eyes, samples) has no such reference.
void measureProgram(const AccuracyRuns& runs, const Words& program, int64_t frames, bool quick, const SayProgress& say, std::vector<AccuracyRow>& rows);

} // namespace mural::cli
