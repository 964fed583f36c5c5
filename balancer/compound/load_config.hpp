// Reads, resolves and checks a configuration: all that is done before it is used.
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

// strict: what could be understood all the same is an error.
LoadedConfig loadConfig(const std::string& path, const config::EnvironmentLookup& environment, bool strict = false);
// The same for a configuration that a program made; `name` is what messages call it.
LoadedConfig loadConfig(config::ConfigFile file, const std::string& name, const config::EnvironmentLookup& environment);

// What the process was started with.
std::optional<std::string> processEnvironment(const std::string& name);

} // namespace mural::compound
