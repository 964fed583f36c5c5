#include "balancer/compound/load_config.hpp"

#include <cstdlib>

#include "balancer/compound/check_config.hpp"
#include "balancer/config/resolve.hpp"
#include "balancer/config/eqc/parser.hpp"

namespace mural::compound {

namespace {

void complete(LoadedConfig& loaded, const config::EnvironmentLookup& environment) {
    if (!loaded.ok()) return;
    const config::Globals globals = config::globalsOfEnvironment(environment, loaded.diagnostics);
    loaded.resolved = config::resolve(loaded.file, globals, loaded.diagnostics);
    if (loaded.ok()) checkConfig(loaded.resolved, loaded.diagnostics);
}

} // namespace

LoadedConfig loadConfig(const std::string& path, const config::EnvironmentLookup& environment, bool strict) {
    LoadedConfig loaded{{}, {}, config::Diagnostics(path, strict)};
    loaded.file = config::readConfigFile(path, loaded.diagnostics);
    complete(loaded, environment);
    return loaded;
}

LoadedConfig loadConfig(config::ConfigFile file, const std::string& name,
                        const config::EnvironmentLookup& environment) {
    LoadedConfig loaded{std::move(file), {}, config::Diagnostics(name)};
    complete(loaded, environment);
    return loaded;
}

std::optional<std::string> processEnvironment(const std::string& name) {
    const char* value = std::getenv(name.c_str());
    return value != nullptr ? std::optional<std::string>(value) : std::nullopt;
}

} // namespace mural::compound
