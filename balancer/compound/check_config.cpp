#include "balancer/compound/check_config.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "balancer/compound/check_frames.hpp"
#include "balancer/compound/even_split.hpp"
#include "balancer/compound/plan_frame.hpp"

namespace mural::compound {

namespace {

std::string nameOr(const std::string& name, size_t number) {
    return name.empty() ? "number " + std::to_string(number) : "\"" + name + "\"";
}

// Returns the number of frames after which the plan repeats, limited to the number that can be checked.
uint64_t repeatsAfter(const ResolvedConfig& config) {
    constexpr uint64_t kMax = 64;
    uint64_t all = 1;
    for (const config::ResolvedCompound& c : config.compounds) {
        const uint64_t period = std::clamp<uint64_t>(c.period.value_or(1), 1, kMax);
        all = std::min(kMax, std::lcm(all, period));
    }
    return all;
}

// Plans every layout, mono and stereo, for all frame numbers until the plan repeats.
void checkDeadlocks(const ResolvedConfig& config, config::Diagnostics& diagnostics) {
    size_t layouts = 1;
    for (const config::ResolvedCanvas& c : config.canvases) layouts = std::max(layouts, c.layouts.size());
    constexpr size_t kMaxCompounds = 20'000'000; // bounds the check to a few seconds
    FrameInput input = firstFrame(config);
    std::set<std::string> reported;
    size_t tried = 0;
    for (size_t layout = 0; layout < layouts; ++layout) {
        input.activeLayouts.assign(config.canvases.size(), static_cast<Index>(layout));
        for (const auto mode : {config::ViewMode::Mono, config::ViewMode::Stereo}) {
            input.views.assign(config.views.size(), ViewState{mode, 1, {}});
            for (input.frameNumber = 0; input.frameNumber < repeatsAfter(config); ++input.frameNumber) {
                tried += config.compounds.size();
                if (tried > kMaxCompounds) {
                    diagnostics.warn({},
                                     "too many layouts and frame numbers to check for frames that wait for each other",
                                     "divide the file, or use shorter periods");
                    return;
                }
                const FramePlan plan = planFrame(config, input);
                if (plan.deadlock.empty()) continue;
                std::string circle;
                std::set<std::string> names; // order independent of the entry into the cycle
                for (const Index f : plan.deadlock) names.insert(plan.frames[at(f)].name);
                for (const std::string& name : names) circle += (circle.empty() ? "\"" : ", \"") + name + "\"";
                if (!reported.insert(circle).second) continue;
                const PlannedFrame& first = plan.frames[at(plan.deadlock.front())];
                const std::string cycle = names.size() == 1 ? "frame " + circle + " waits for itself"
                                                            : "frames " + circle + " wait for each other";
                diagnostics.error(config.compounds[at(first.compound)].at, cycle + ": no picture is ever drawn",
                                  "read one of them back before it is needed");
            }
        }
    }
}

void checkEqualizers(const ResolvedConfig& config, config::Diagnostics& diagnostics) {
    for (const config::ResolvedCompound& c : config.compounds) {
        for (const config::Equalizer& e : c.equalizers) {
            const bool divides =
                std::holds_alternative<config::LoadEqualizer>(e) || std::holds_alternative<config::TreeEqualizer>(e);
            const config::SourcePosition place = std::visit([](const auto& one) { return one.at; }, e);
            if (divides && c.children.size() < 2)
                diagnostics.warn(place, "this equalizer has no effect: its compound has fewer than two children",
                                 "move it to the compound whose children it balances");
            if (divides && c.destination == kNone)
                diagnostics.warn(place, "this equalizer belongs to a compound without a channel",
                                 "move it to the compound with the destination's channel");
        }
    }
}

void checkDisplays(const ResolvedConfig& config, config::Diagnostics& diagnostics) {
    std::vector<bool> seen(config.views.size(), false), used(config.layouts.size(), false);
    for (const config::ResolvedChannel& c : config.channels) {
        if (c.isDestination()) seen[at(c.view)] = true;
    }
    for (const config::ResolvedCanvas& c : config.canvases) {
        for (const Index l : c.layouts) {
            if (l != kNone) used[at(l)] = true;
        }
    }
    for (size_t l = 0; l < used.size(); ++l) {
        if (!used[l])
            diagnostics.warn(config.layouts[l].at,
                             "layout " + nameOr(config.layouts[l].name, l) +
                                 " is not used by a canvas and is never shown",
                             "add it to a canvas, or remove it");
    }
    for (size_t v = 0; v < seen.size(); ++v) {
        if (!seen[v] && used[at(config.views[v].layout)])
            diagnostics.warn(config.views[v].at,
                             "view " + nameOr(config.views[v].name, v) +
                                 " does not overlap a segment and is never shown",
                             "move its viewport over a segment");
    }
}

// A reference by name finds only the first of two channels with the same name.
void checkNames(const ResolvedConfig& config, config::Diagnostics& diagnostics) {
    std::set<std::string> names;
    for (const config::ResolvedChannel& c : config.channels) {
        if (c.isDestination() || c.name.empty() || names.insert(c.name).second) continue;
        diagnostics.warn(c.at, "duplicate channel name \"" + c.name + "\": references find only the first one",
                         "rename it");
    }
}

} // namespace

void checkConfig(const ResolvedConfig& config, config::Diagnostics& diagnostics) {
    checkNames(config, diagnostics);
    checkDisplays(config, diagnostics);
    checkEqualizers(config, diagnostics);
    checkFrames(config, diagnostics);
    if (config.channels.empty())
        diagnostics.warn({}, "the file has no channel, so nothing is drawn",
                         "define a node with a pipe, a window and a channel");
    if (diagnostics.errors() == 0) checkDeadlocks(config, diagnostics);
}

} // namespace mural::compound
