// Prints the results as a table or as JSON.
#pragma once

#include <string>

#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

[[nodiscard]] std::string tableOf(const AccuracyReport& report);
[[nodiscard]] std::string jsonOf(const AccuracyReport& report);

// "0", "12", "1 234 567".
[[nodiscard]] std::string spaced(int64_t number);

} // namespace mural::cli
