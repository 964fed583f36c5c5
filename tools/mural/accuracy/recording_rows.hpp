// Replays a trace with every decomposition: compared with one node, and few samples with many.
#pragma once

#include "tools/mural/accuracy/accuracy_row.hpp"
#include "tools/mural/accuracy/accuracy_runs.hpp"

namespace mural::cli {

// Validates the whole trace before replay.
Result<void> checkRecording(const std::string& recording);

void measureRecording(const AccuracyRuns& runs, const std::string& recording, bool quick,
                      std::vector<AccuracyRow>& rows);

} // namespace mural::cli
