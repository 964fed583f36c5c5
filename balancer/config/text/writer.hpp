// Writes a configuration as canonical text: what was said, in the order of section_fields.hpp, in today's words.
// Reading it again gives the same configuration. Comments other than those at the beginning are lost.
#pragma once

#include <string>

#include "balancer/config/config.hpp"

namespace mural::config {

std::string writeConfig(const ConfigFile& file);

} // namespace mural::config
