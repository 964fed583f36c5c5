// A configuration from the sections of a config, for tests.
#pragma once

#include <string>

#include "balancer/compound/load_config.hpp"
#include "balancer/config/eqc/parser.hpp"

namespace mural::balance::testing {

inline compound::LoadedConfig configOf(const std::string& sections) {
    config::Diagnostics diagnostics("test.eqc");
    auto file = config::parseConfig("#Equalizer 1.2 ascii\nserver { config { " + sections + " } }", diagnostics);
    return compound::loadConfig(std::move(file), "test.eqc",
                                [](const std::string&) { return std::optional<std::string>(); });
}

} // namespace mural::balance::testing
