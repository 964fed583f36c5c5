#include "nodes/head/planning/make_plan.hpp"

#include <utility>

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

// Returns the host on which nodes of `host` run (SessionConfig::movedHosts).
std::string movedTo(std::string host, const std::vector<std::string>& moves) {
    for (const std::string& move : moves)
        if (const size_t at = move.find('='); at != std::string::npos && move.substr(0, at) == host)
            host = move.substr(at + 1);
    return host;
}

} // namespace

Result<SessionPlan> makePlan(const SessionConfig& wanted, const std::string& ownHost) {
    SessionConfig config = wanted;
    for (std::string& host : config.hosts) host = movedTo(host, config.movedHosts);
    if (config.configFile.empty() && !movesWork(config)) return planSession(config, ownHost);
    auto loaded = loadFor(config);
    if (!loaded) return loaded.error();
    if (!loaded->ok()) return Error{loaded->diagnostics.firstError()};
    auto plan = planOf(*loaded, {ownHost, config.allLocal, config.canvas, config.layouts, config.projection,
                                 config.modelUnit, config.width, config.balance});
    if (!plan) return plan;
    for (NodePlan& node : plan->nodes) {
        const std::string host = movedTo(node.where, config.movedHosts);
        if (std::exchange(node.where, host) != host) node.reach = reachOf(host, ownHost);
    }
    chooseComposition(*plan, config.composition);
    chooseCodecs(*plan, config.codec);
    settleBalance(*plan, config);
    return plan;
}

} // namespace mural
