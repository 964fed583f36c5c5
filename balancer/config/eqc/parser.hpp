// Parses a configuration file: Equalizer's format 1.0 to 1.2 as its releases since 2005 wrote it, and Mural's
// extensions. Constructs of early releases cause a warning. The parser does not resolve names; resolve() does.
#pragma once

#include "balancer/config/config.hpp"
#include "balancer/config/diagnostics.hpp"

namespace mural::config {

// After an error (diagnostics.errors() > 0) the result holds the part before it and is unusable.
ConfigFile parseConfig(std::string_view text, Diagnostics& diagnostics);

// Adds an error to `diagnostics` if the file cannot be read.
ConfigFile readConfigFile(const std::string& path, Diagnostics& diagnostics);

} // namespace mural::config
