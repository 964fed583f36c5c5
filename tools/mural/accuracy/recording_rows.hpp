// A recording of a program, replayed in every way: against itself by one node; what samples are short of against many of them.
#pragma once

#include "tools/mural/accuracy/accuracy_row.hpp"
#include "tools/mural/accuracy/accuracy_runs.hpp"

namespace mural::cli {

// What can be said against it before it is replayed; all of it is read.
Result<void> checkRecording(const std::string& recording, const SayProgress& say);

void measureRecording(const AccuracyRuns& runs, const std::string& recording, bool quick, const SayProgress& say, std::vector<AccuracyRow>& rows);

} // namespace mural::cli
