// Prints the doctor's checks: one line each, or JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/mural/doctor/doctor_checks.hpp"

namespace mural::cli {

void printChecks(const std::vector<Check>& checks);
nlohmann::json toJson(const std::vector<Check>& checks);
// Returns true if no check is bad.
bool usable(const std::vector<Check>& checks);

} // namespace mural::cli
