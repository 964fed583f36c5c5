// The report as one page without references to other files.
#pragma once

#include "tools/mural/app_report/app_report.hpp"

namespace mural::cli {

std::string htmlOf(const AppReport& report);

// Escapes the characters with a meaning in HTML.
std::string escaped(const std::string& text);

} // namespace mural::cli
