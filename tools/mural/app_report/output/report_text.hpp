// The report as text for a terminal.
#pragma once

#include "tools/mural/app_report/app_report.hpp"

namespace mural::cli {

std::string textOf(const AppReport& report);

// The program and its arguments, separated by blanks.
std::string programText(const AppReport& report);

} // namespace mural::cli
