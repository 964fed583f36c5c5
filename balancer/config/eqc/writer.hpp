// Writes a configuration in canonical form: the stated values in the order of section_fields.hpp, in today's words.
// Reading the result gives the same configuration. Only leading comments are kept.
#pragma once

#include <string>

#include "balancer/config/config.hpp"

namespace mural::config {

std::string writeConfig(const ConfigFile& file);

} // namespace mural::config
