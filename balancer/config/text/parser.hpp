// Reads a configuration file: Equalizer's format 1.0 to 1.2 as its releases since 2005 wrote it, and Mural's additions.
// What early releases wrote is understood with a warning. The text is only read here: names are looked up by resolve().
#pragma once

#include "balancer/config/config.hpp"
#include "balancer/config/diagnostics.hpp"

namespace mural::config {

// After an error (diagnostics.errors() > 0) the result holds what was read before it, and is not for use.
ConfigFile parseConfig(std::string_view text, Diagnostics& diagnostics);

// An error in `diagnostics` when the file can't be read.
ConfigFile readConfigFile(const std::string& path, Diagnostics& diagnostics);

} // namespace mural::config
