// Compares two reports of `mural app-report --json`.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/base/result.hpp"

namespace mural::cli {

// Returns one line per fact that differs. Numbers that vary from run to run count as equal within a tenth. Errors: one
// of them is no report.
Result<std::vector<std::string>> differencesOf(const nlohmann::json& first, const nlohmann::json& second);

} // namespace mural::cli
