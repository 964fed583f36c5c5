// Reads, resolves and checks a configuration before its use.
#pragma once

#include "balancer/compound/display_sizes.hpp"
#include "balancer/config/diagnostics.hpp"
#include "balancer/config/global_attributes.hpp"

namespace mural::compound {

struct LoadedConfig {
    config::ConfigFile file;
    ResolvedConfig resolved;
    config::Diagnostics diagnostics;
    [[nodiscard]] bool ok() const { return diagnostics.errors() == 0; }
};

// Loads a file. `strict` turns recoverable problems into errors.
LoadedConfig loadConfig(const std::string& path, const config::EnvironmentLookup& environment, bool strict = false);
// Resolves and checks a configuration that a program made. Messages refer to it as `name`.
LoadedConfig loadConfig(config::ConfigFile file, const std::string& name, const config::EnvironmentLookup& environment);

// Returns a variable of the process environment.
std::optional<std::string> processEnvironment(const std::string& name);

} // namespace mural::compound
