#include "nodes/head/planning/config/canvas_choice.hpp"

#include <algorithm>
#include <cmath>

#include "balancer/compound/active_layouts.hpp"
#include "balancer/compound/even_split.hpp"

namespace mural {
namespace {

using compound::PixelSize;
using config::at;
using config::Index;
using config::kNone;

Index canvasOf(const config::ResolvedConfig& config, const ConfigDraw& draw) {
    const Index segment = config.channels[at(draw.context.destination)].segment;
    return segment == kNone ? kNone : config.segments[at(segment)].canvas;
}

} // namespace

Result<compound::FrameInput> chooseLayouts(const ConfigSource& source, const PlanOptions& options) {
    compound::FrameInput input = compound::firstFrame(source.config);
    input.activeLayouts.resize(source.config.canvases.size(), 0);
    input.views.resize(source.config.views.size());
    for (compound::ViewState& view : input.views) view.modelUnit = options.modelUnit;
    for (const std::string& wanted : options.layouts)
        if (!compound::activateLayout(source.config, wanted, input))
            return Error{"--layout \"" + wanted + "\": no canvas of " + source.file +
                         " has this layout; mural config print shows the layouts"};
    return input;
}

Result<CanvasChoice> chooseCanvas(const ConfigSource& source, const std::string& name, Index only,
                                  std::vector<ConfigDraw>& draws) {
    CanvasChoice choice;
    std::set<Index>& canvases = choice.canvases;
    for (const ConfigDraw& d : draws) canvases.insert(canvasOf(source.config, d));
    if (only != kNone) canvases = {only};
    choice.canvas = canvases.empty() ? kNone : *canvases.begin();
    if (!name.empty()) {
        const auto named = std::ranges::find_if(
            canvases, [&](Index c) { return c != kNone && source.config.canvases[at(c)].name == name; });
        if (named == canvases.end())
            return Error{"--canvas \"" + name + "\": " + source.file +
                         " has no channel on a canvas of this name; mural config print shows the canvases"};
        choice.canvas = *named;
        canvases = {choice.canvas};
    }
    std::erase_if(draws, [&](const ConfigDraw& d) { return canvasOf(source.config, d) != choice.canvas; });
    return choice;
}

PixelSize canvasSize(const config::ResolvedConfig& config, Index canvas) {
    if (canvas == kNone) return {0, 0};
    const compound::DisplaySizes sizes = compound::displaySizes(config);
    for (const Index s : config.canvases[at(canvas)].segments) {
        const config::ResolvedSegment& segment = config.segments[at(s)];
        if (segment.channel == kNone || segment.viewport.empty()) continue;
        const PixelViewport& pixels = sizes.channels[at(segment.channel)];
        return {static_cast<int32_t>(std::lround(pixels.w / segment.viewport.w)),
                static_cast<int32_t>(std::lround(pixels.h / segment.viewport.h))};
    }
    return {0, 0};
}

} // namespace mural
