#include "nodes/head/planning/config_plan.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "nodes/head/planning/config/explain_nodes.hpp"
#include "nodes/head/planning/config/plan_canvas.hpp"
#include "nodes/head/planning/unsupported_fields.hpp"

namespace mural {

namespace {

using compound::LoadedConfig;
using config::at;
using config::Index;
using config::kNone;

// Returns the canvas's name in the file, or its number.
std::string canvasName(const config::ResolvedConfig& config, Index canvas) {
    const std::string& name = config.canvases[at(canvas)].name;
    return name.empty() ? std::to_string(canvas) : name;
}

// Returns the canvas's name in messages.
std::string canvasTitle(const config::ResolvedConfig& config, Index canvas) {
    const std::string& name = config.canvases[at(canvas)].name;
    return "canvas " + (name.empty() ? std::to_string(canvas) : "\"" + name + "\"");
}

// Appends the plan of another canvas. Its nodes draw the program's picture at its own resolution.
void addCanvas(SessionPlan& plan, SessionPlan other, CanvasPlan canvas) {
    const auto nodes = static_cast<int>(plan.nodes.size());
    int pictures = picturesOf(plan.wall);
    for (const CanvasPlan& c : plan.canvases) pictures = std::max(pictures, picturesOf(c.wall));
    canvas.wall = std::move(other.wall);
    canvas.nodesShowWall = other.nodesShowWall;
    canvas.size = other.size;
    for (WallPart& part : canvas.wall.parts) part.firstPicture += pictures;
    for (NodePlan& node : other.nodes) {
        node.node += nodes;
        node.collector += nodes;
        node.canvas = static_cast<int>(plan.canvases.size()) + 1;
        node.picture += pictures;
        node.answers = false;
        node.pass.zoom = compose(node.pass.zoom, canvas.shown);
        node.pass.zoom = {std::min(node.pass.zoom.x, kMaxZoom), std::min(node.pass.zoom.y, kMaxZoom)};
        node.pass.shown = canvas.shown;
        if (node.window && node.window->asOnWall) node.window->x += canvas.offsetX;
        plan.nodes.push_back(std::move(node));
    }
    std::ranges::move(other.explain, std::back_inserter(plan.explain));
    std::ranges::move(other.warnings, std::back_inserter(plan.warnings));
    if (!plan.eyeBase) plan.eyeBase = other.eyeBase, plan.focusDistance = other.focusDistance;
    plan.canvases.push_back(std::move(canvas));
}

void addOtherCanvases(const LoadedConfig& loaded, const PlanOptions& options, const CanvasChoice& first,
                      SessionPlan& plan) {
    const config::ResolvedConfig& config = loaded.resolved;
    const compound::PixelSize own = canvasSize(config, first.canvas);
    int offsetX = options.width > 0 ? options.width : own.w;
    for (const Index c : first.canvases) {
        if (c == first.canvas || c == kNone) continue;
        const std::string title = canvasTitle(config, c);
        const compound::PixelSize size = canvasSize(config, c);
        auto planned = planCanvas(loaded, options, c, static_cast<int>(plan.nodes.size()));
        if (!planned || size.w <= 0 || own.w <= 0) {
            plan.warnings.push_back(
                title + " is not shown: " +
                (planned ? "its size is unknown; give its channels a viewport in pixels" : planned.error().message));
            continue;
        }
        CanvasPlan canvas;
        canvas.name = canvasName(config, c);
        canvas.shown = {static_cast<double>(size.w) / own.w, static_cast<double>(size.h) / own.h};
        if (canvas.shown.x > kMaxZoom || canvas.shown.y > kMaxZoom) {
            plan.warnings.push_back(title + " has more than " + std::to_string(static_cast<int>(kMaxZoom)) +
                                    " times the pixels of the first canvas in one direction; it is shown with this "
                                    "limit; --canvas shows it alone");
            canvas.shown = {std::min(canvas.shown.x, kMaxZoom), std::min(canvas.shown.y, kMaxZoom)};
        }
        canvas.offsetX = offsetX;
        offsetX += static_cast<int>(std::lround(canvas.shown.x * (options.width > 0 ? options.width : own.w)));
        plan.explain.push_back(title + " shows the program's picture with " + std::to_string(size.w) + "x" +
                               std::to_string(size.h) + " pixels; the first canvas has " + std::to_string(own.w) + "x" +
                               std::to_string(own.h));
        addCanvas(plan, std::move(planned->plan), std::move(canvas));
    }
}

// Returns a canvas without nodes, in the size of the first canvas's pixels. Empty: a size is unknown.
std::optional<CanvasPlan> emptyCanvas(const config::ResolvedConfig& config, Index canvas, Index first, int offsetX) {
    const compound::PixelSize size = canvasSize(config, canvas), own = canvasSize(config, first);
    if (size.w <= 0 || own.w <= 0) return {};
    CanvasPlan plan;
    plan.name = canvasName(config, canvas);
    plan.nodesShowWall = false;
    plan.shown = {static_cast<double>(size.w) / own.w, static_cast<double>(size.h) / own.h};
    plan.size = millimetresOf(config.canvases[at(canvas)]);
    plan.offsetX = offsetX;
    return plan;
}

// Adds pictures of canvases that other channels show again. Canvases that show nothing else follow the others.
class CopyAdder {
public:
    CopyAdder(const LoadedConfig& loaded, const PlanOptions& options, Index first, SessionPlan& plan)
        : config_(loaded.resolved), options_(options), first_(first), plan_(plan) {}

    void add(const CanvasCopy& copy) {
        const bool isLeftOut = !options_.canvas.empty() && config_.canvases[at(copy.target)].name != options_.canvas;
        if (isLeftOut) return; // --canvas shows another one alone
        const std::optional<int> source = numberOf(copy.source);
        if (!source) return warn(copy, "that canvas is not shown");
        if (!numberOf(copy.target) && !addEmpty(copy)) return;
        const int target = *numberOf(copy.target);
        WallComposition& wall = target == 0 ? plan_.wall : canvas(target).wall;
        const bool hasEyePairs = !wall.parts.empty() && wall.stereo != StereoMode::Off &&
                                 wall.stereo != StereoMode::Anaglyph && wall.parts.front().eye != Eye::Cyclop;
        if (hasEyePairs) return warn(copy, "it has a picture for each eye");
        wall.copies.push_back({*source, copy.from, copy.to});
        (target == 0 ? plan_.nodesShowWall : canvas(target).nodesShowWall) = false;
        plan_.explain.push_back(canvasTitle(config_, copy.target) + " shows part " + bracketed(copy.from) + " of " +
                                canvasTitle(config_, copy.source) + " in part " + bracketed(copy.to));
    }

private:
    CanvasPlan& canvas(int number) { return plan_.canvases[static_cast<size_t>(number) - 1]; }

    // Returns 0 for the first canvas, n for SessionPlan::canvases[n - 1].
    [[nodiscard]] std::optional<int> numberOf(Index canvas) const {
        if (canvas == first_) return 0;
        const auto found = std::ranges::find(plan_.canvases, canvasName(config_, canvas), &CanvasPlan::name);
        if (found == plan_.canvases.end()) return {};
        return static_cast<int>(found - plan_.canvases.begin()) + 1;
    }

    bool addEmpty(const CanvasCopy& copy) {
        const int width = options_.width > 0 ? options_.width : canvasSize(config_, first_).w;
        double offset = width;
        for (const CanvasPlan& other : plan_.canvases) offset += other.shown.x * width;
        auto added = emptyCanvas(config_, copy.target, first_, static_cast<int>(std::lround(offset)));
        if (added)
            plan_.canvases.push_back(std::move(*added));
        else
            warn(copy, "a size is unknown; give its channels a viewport in pixels");
        return added.has_value();
    }

    void warn(const CanvasCopy& copy, const std::string& why) {
        plan_.warnings.push_back(canvasTitle(config_, copy.target) + " shows no picture of " +
                                 canvasTitle(config_, copy.source) + ": " + why);
    }

    const config::ResolvedConfig& config_;
    const PlanOptions& options_;
    const Index first_;
    SessionPlan& plan_;
};

} // namespace

Result<SessionPlan> planOf(const LoadedConfig& loaded, const PlanOptions& options) {
    auto first = planCanvas(loaded, options);
    if (!first) return first.error();
    SessionPlan plan = std::move(first->plan);
    if (first->choice.canvas != kNone) plan.canvas = canvasName(loaded.resolved, first->choice.canvas);
    addOtherCanvases(loaded, options, first->choice, plan);
    CopyAdder copies(loaded, options, first->choice.canvas, plan);
    for (const CanvasCopy& copy : first->copies) copies.add(copy);
    std::ranges::copy(fieldsWithoutEffect(loaded.diagnostics), std::back_inserter(plan.warnings));
    return plan;
}

compound::PixelSize wallSizeOf(const LoadedConfig& loaded, const PlanOptions& options) {
    const config::ResolvedConfig& config = loaded.resolved;
    if (!chooseLayouts({config, loaded.diagnostics.file()}, options)) return {0, 0};
    for (size_t c = 0; c < config.canvases.size(); ++c) {
        if (!options.canvas.empty() && config.canvases[c].name != options.canvas) continue;
        if (const compound::PixelSize size = canvasSize(config, static_cast<Index>(c)); size.w > 0) return size;
    }
    return {0, 0};
}

} // namespace mural
