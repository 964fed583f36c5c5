// Sections of the report about round trips, bytes, memory and speed.
#pragma once

#include "tools/mural/app_report/app_report.hpp"
#include "tools/mural/app_report/runs/app_runs.hpp"

namespace mural::cli {

Section roundTripFacts(const AppMeasured& measured);
Section trafficFacts(const AppMeasured& measured);
Section speedFacts(const AppMeasured& measured);

// Round trips of the program itself per frame; --verify adds none.
double roundTripsPerFrame(const AppMeasured& measured);

} // namespace mural::cli
