// The section of the report about ways to divide the work.
#pragma once

#include "tools/mural/app_report/app_report.hpp"
#include "tools/mural/app_report/runs/app_runs.hpp"

namespace mural::cli {

Section divisionFacts(const AppMeasured& measured);

// Returns the text of a limit that the head has reported (docs/reference/control-protocol.md); empty: it has not.
std::string limitOf(const AppRun& run, const char* code);
// Parts of the picture can move between nodes without a difference, as far as the run shows.
bool tilesMove(const AppMeasured& measured);
// Share of the frames in which nodes divided draws, from 0 to 1; -1: unknown.
double sharedPart(const AppMeasured& measured);
// "0 of 123 pixels differ", or the reason why none was compared.
std::string comparisonText(const AppRun& run);

} // namespace mural::cli
