// What a configuration file says and a session does not do: said, so that nobody looks for its effect.
#pragma once

#include <string>
#include <vector>

#include "balancer/config/diagnostics.hpp"

namespace mural {

// A line for each such field, where it stands first: "FILE:LINE:COLUMN: what; remedy".
[[nodiscard]] std::vector<std::string> fieldsWithoutEffect(const config::Diagnostics& read);

} // namespace mural
