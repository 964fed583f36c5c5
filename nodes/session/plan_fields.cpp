#include "nodes/session/plan_fields.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/json/json_text.hpp"

namespace mural {

namespace {

constexpr std::string_view kPlanFields[] = {
    "columns",    "rows",        "tileWidth", "tileHeight",    "chunks",    "balance",   "localNodes",  "hosts",
    "configFile", "allLocal",    "canvas",    "layouts",       "stereo",    "modelUnit", "kernelWidth", "kernelHeight",
    "samples",    "period",      "ranges",    "zoomX",         "zoomY",     "codec",     "readback",    "projection",
    "eyeBase",    "composition", "tiling",    "focusDistance", "movedHosts"};

constexpr int kMaxTilesPerSide = 256, kMaxKernel = 16, kMaxPasses = 256, kMaxChunks = 4096, kMaxNodes = 1024;
constexpr int kMaxSide = 1 << 15; // pixels of a tile
constexpr double kMinZoom = 0.01;

// Returns an error for numbers beyond those of the options of mural run.
Result<void> checkLimits(const SessionConfig& c) {
    const PassCounts& p = c.passes;
    const auto nodes = static_cast<int64_t>(c.hosts.size()) + c.localNodes;
    if (c.columns > kMaxTilesPerSide || c.rows > kMaxTilesPerSide || c.tileWidth > kMaxSide || c.tileHeight > kMaxSide)
        return Error{"the plan has more than 256 tiles per side, or tiles of more than 32768 pixels"};
    const bool isInLimits = p.kernelWidth <= kMaxKernel && p.kernelHeight <= kMaxKernel && p.samples <= kMaxPasses &&
                            p.period <= kMaxPasses && p.ranges <= kMaxPasses && c.chunks <= kMaxChunks;
    const int64_t passes = isInLimits ? int64_t{1} * p.kernelWidth * p.kernelHeight * p.samples * p.period * p.ranges *
                                            (p.stereo == StereoMode::Off ? 1 : 2)
                                      : 0;
    if (!isInLimits || passes > kMaxPasses) return Error{"the plan has more than 256 passes, or 4096 chunks"};
    if (nodes > kMaxNodes) return Error{"the plan has more than 1024 nodes"};
    if (p.zoom.x < kMinZoom || p.zoom.y < kMinZoom) return Error{"the plan has a zoom below 0.01"};
    if (c.tiling == Tiling::Lean && (passes > 1 || !p.zoom.none() || !c.configFile.empty()))
        return Error{"lean tiling excludes several passes, zooms and configuration files"};
    return {};
}

} // namespace

nlohmann::json planFieldsOf(const SessionConfig& config) {
    const nlohmann::json all = parseJson(toJson(config));
    nlohmann::json fields = nlohmann::json::object();
    for (const std::string_view name : kPlanFields) fields[std::string(name)] = all.at(std::string(name));
    return fields;
}

Result<SessionConfig> withPlanFields(const SessionConfig& config, const nlohmann::json& fields) {
    nlohmann::json all = parseJson(toJson(config));
    for (const auto& [name, value] : fields.items()) {
        if (std::ranges::find(kPlanFields, name) == std::end(kPlanFields))
            return Error{"\"" + name.substr(0, 40) + "\" is no field of a plan; mural ctl plan lists them"};
        all[name] = value;
    }
    auto changed = sessionConfigFromJson(jsonText(all));
    if (!changed) return changed;
    if (const auto possible = checkLimits(*changed); !possible) return possible.error();
    return changed;
}

} // namespace mural
