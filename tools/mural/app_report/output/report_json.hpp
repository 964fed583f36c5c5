// The report as JSON, for programs and for comparison.
#pragma once

#include "tools/mural/app_report/app_report.hpp"

namespace mural::cli {

nlohmann::json jsonOf(const AppReport& report);

} // namespace mural::cli
