// Sections of the report about the program and its commands.
#pragma once

#include "tools/mural/app_report/app_report.hpp"
#include "tools/mural/app_report/runs/app_runs.hpp"

namespace mural::cli {

// GL, toolkits, processes, and the way of capture.
Section captureFacts(const AppMeasured& measured);
// Commands and extensions, used and not supported.
Section commandFacts(const AppMeasured& measured);
// The ends of the runs.
Section endFacts(const AppMeasured& measured);

// Returns the names, separated by commas, at most `most` of them.
std::string listText(const std::vector<std::string>& names, size_t most = 12);

} // namespace mural::cli
