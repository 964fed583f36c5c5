// Draws a configuration as SVG: displays, machines, and compound trees with the frames between compounds. Each machine
// has one colour throughout; with a single machine, each GPU.
#pragma once

#include <string>

#include "balancer/compound/load_config.hpp"

namespace mural::drawing {

std::string drawConfig(const config::ResolvedConfig& config, const std::string& title,
                       const std::vector<std::string>& heading);

} // namespace mural::drawing
