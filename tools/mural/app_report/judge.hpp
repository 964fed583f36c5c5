// Derives the report from the runs. Pure.
#pragma once

#include "tools/mural/app_report/app_report.hpp"
#include "tools/mural/app_report/runs/app_runs.hpp"

namespace mural::cli {

struct Judgement {
    Verdict verdict = Verdict::NotCapturable;
    std::string sentence; // the reason
};

Judgement judge(const AppMeasured& measured);
// Returns the command line for a wall; empty: the program does not run on one.
std::string recommendedCommand(const AppMeasured& measured, Verdict verdict);

AppReport makeReport(const AppMeasured& measured);

} // namespace mural::cli
