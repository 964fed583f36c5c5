// A configuration as a picture: what is shown where, the machines, and the trees of compounds with the frames that they
// hand to each other. Each machine has one colour throughout; with
// one machine, each of its GPUs.
#pragma once

#include <string>

#include "balancer/compound/load_config.hpp"

namespace mural::drawing {

std::string drawConfig(const config::ResolvedConfig& config, const std::string& title, const std::vector<std::string>& heading);

} // namespace mural::drawing
