// `mural run --print-config`: the configuration file that is equivalent to the other options.
#include "balancer/config/eqc/parser.hpp"
#include "balancer/config/eqc/writer.hpp"
#include "nodes/head/planning/preset_plan.hpp"
#include "tools/mural/run/run_option_readers.hpp"

namespace mural::cli {

Result<std::string> configTextOf(const RunArguments& a, const SessionConfig& c) {
    if (a.config) {
        config::Diagnostics ignored(*a.config);
        return config::writeConfig(config::readConfigFile(*a.config, ignored));
    }
    auto form = presetOf(c);
    if (!form) return Error{"--print-config: " + form.error().message};
    auto file = config::shortForm(*form);
    if (!file) return file.error();
    return config::writeConfig(*file);
}

} // namespace mural::cli
