// Options of `mural run` for a configuration file.
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

#include "nodes/head/planning/config_plan.hpp"
#include "nodes/launch/private_display.hpp"
#include "tools/mural/run/option_choices.hpp"
#include "tools/mural/run/run_option_readers.hpp"

namespace mural::cli {

namespace {

Result<void> readProjection(const RunArguments& a, SessionConfig& c) {
    if (auto r = choose("--projection", a.projection, kProjectionChoices, c.projection); !r) return r;
    return readReal("--model-unit", a.modelUnit, 1e-9, c.modelUnit);
}

} // namespace

Result<void> readConfigFile(const RunArguments& a, RunOptions& options) {
    SessionConfig& c = options.config;
    if (!a.config) {
        const std::pair<const char*, bool> ofFiles[] = {{"--all-local", a.allLocal},
                                                        {"--canvas", a.canvas.has_value()},
                                                        {"--layout", !a.layouts.empty()},
                                                        {"--projection", a.projection.has_value()},
                                                        {"--model-unit", a.modelUnit.has_value()}};
        for (const auto& [option, given] : ofFiles)
            if (given) return Error{fmt::format("{} requires a configuration file; add --config FILE", option)};
        return {};
    }
    const std::pair<const char*, bool> contradicting[] = {{"--tiles", a.tiles.has_value()},
                                                          {"--tile-queue", a.tileQueue.has_value()},
                                                          {"--chunk-queue", a.chunkQueue.has_value()},
                                                          {"--nodes", a.nodes.has_value()},
                                                          {"--local-nodes", a.localNodes.has_value()},
                                                          {"--stereo", a.stereo.has_value()},
                                                          {"--pixel", a.pixel.has_value()},
                                                          {"--subpixel", a.subpixel.has_value()},
                                                          {"--dplex", a.dplex.has_value()},
                                                          {"--db", a.db.has_value()},
                                                          {"--zoom", a.zoom.has_value()}};
    for (const auto& [option, given] : contradicting)
        if (given) return Error{fmt::format("{} and --config both divide the work; omit one of them", option)};
    if (c.tiling == Tiling::Lean) return Error{"--tiling lean does not support --config; omit it"};
    const auto loaded = compound::loadConfig(*a.config, compound::processEnvironment);
    for (const config::Diagnostic& d : loaded.diagnostics.all())
        if (d.severity == config::Severity::Warning) options.notices.push_back(loaded.diagnostics.text(d));
    if (!loaded.ok())
        return Error{loaded.diagnostics.firstError() + (loaded.diagnostics.errors() > 1
                                                            ? fmt::format(" (and {} more: mural config check {})",
                                                                          loaded.diagnostics.errors() - 1, *a.config)
                                                            : "")};
    if (auto r = readProjection(a, c); !r) return r;
    const PlanOptions planOptions{"", a.allLocal, a.canvas.value_or(""), a.layouts, c.projection, c.modelUnit};
    auto plan = planOf(loaded, planOptions);
    if (!plan) return plan.error();
    std::error_code failed;
    c.configFile = std::filesystem::absolute(*a.config, failed).string();
    c.allLocal = a.allLocal;
    c.canvas = planOptions.canvas;
    c.layouts = a.layouts;
    if (!a.eyeBase) c.eyeBase = plan->eyeBase.value_or(c.eyeBase);
    if (!a.focus) c.focusDistance = plan->focusDistance.value_or(c.focusDistance);
    const int processes = static_cast<int>(plan->nodes.size());
    if (processes > kMaxNodes)
        return Error{fmt::format("{}: {} render nodes; the maximum is {}", *a.config, processes, kMaxNodes)};
    for (const NodePlan& node : plan->nodes)
        if (node.reach == NodeReach::LaunchCommand) c.hosts.push_back(node.where);
    int turns = 1;
    for (const NodePlan& node : plan->nodes) turns = std::max(turns, node.pass.period);
    if (!a.latency) c.latency = std::max({1, turns, std::min(static_cast<int>(loaded.resolved.latency), kMaxLatency)});
    if (a.size || a.tiles) return {};
    const compound::PixelSize wall = wallSizeOf(loaded, planOptions);
    if (wall.w > launch::kMaxScreenSize || wall.h > launch::kMaxScreenSize || wall.w < 1 || wall.h < 1)
        return Error{fmt::format(
            "{}: its wall has {}x{} pixels, but a screen has at most {} in each direction; set a smaller --size WxH",
            *a.config, wall.w, wall.h, launch::kMaxScreenSize)};
    c.width = wall.w;
    c.height = wall.h;
    return {};
}

} // namespace mural::cli
