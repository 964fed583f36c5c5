// Summarises a configuration in a few lines.
#pragma once

#include <string>
#include <vector>

#include "balancer/compound/load_config.hpp"

namespace mural::cli {

std::vector<std::string> summaryOf(const compound::LoadedConfig& loaded);

} // namespace mural::cli
