#include "nodes/head/planning/make_plan.hpp"

#include "nodes/head/planning/balance_plan.hpp"
#include "nodes/head/planning/codec_choice.hpp"
#include "nodes/head/planning/composition_choice.hpp"
#include "nodes/head/planning/config_plan.hpp"
#include "nodes/head/planning/preset_plan.hpp"

namespace mural {
namespace {

Result<compound::LoadedConfig> loadFor(const SessionConfig& config) {
    if (!config.configFile.empty()) return compound::loadConfig(config.configFile, compound::processEnvironment);
    auto preset = presetOf(config);
    if (!preset) return preset.error();
    auto file = config::shortForm(*preset);
    if (!file) return file.error();
    return compound::loadConfig(std::move(*file), "options", compound::processEnvironment);
}

} // namespace

Result<SessionPlan> makePlan(const SessionConfig& config, const std::string& ownHost) {
    if (config.configFile.empty() && !movesWork(config)) return planSession(config, ownHost);
    auto loaded = loadFor(config);
    if (!loaded) return loaded.error();
    if (!loaded->ok()) return Error{loaded->diagnostics.firstError()};
    auto plan = planOf(*loaded, {ownHost, config.allLocal, config.canvas, config.layouts, config.projection,
                                 config.modelUnit, config.width, config.balance});
    if (!plan) return plan;
    chooseComposition(*plan, config.composition);
    chooseCodecs(*plan, config.codec);
    settleBalance(*plan, config);
    return plan;
}

} // namespace mural
