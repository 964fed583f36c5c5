// Warns about fields of a configuration file that a session ignores.
#pragma once

#include <string>
#include <vector>

#include "balancer/config/diagnostics.hpp"

namespace mural {

// Returns one line per ignored field, at its first occurrence: "FILE:LINE:COLUMN: field; remedy".
[[nodiscard]] std::vector<std::string> fieldsWithoutEffect(const config::Diagnostics& read);

} // namespace mural
