#include "nodes/head/planning/config/plan_canvas.hpp"

#include <variant>

#include "balancer/config/screen.hpp"
#include "nodes/head/planning/config/canvas_copies.hpp"
#include "nodes/head/planning/config/explain_nodes.hpp"
#include "nodes/head/planning/config/follow_frames.hpp"
#include "nodes/head/planning/config/node_windows.hpp"
#include "nodes/head/planning/config/place_nodes.hpp"
#include "nodes/head/planning/config/projection_choice.hpp"
#include "nodes/head/planning/config/wall_parts.hpp"

namespace mural {

// A surface without a position in the file is the default wall.
CanvasMillimetres millimetresOf(const config::ResolvedCanvas& canvas) {
    const bool isGiven = std::visit([](const auto& s) { return s.at.line > 0; }, canvas.surface);
    if (!isGiven) return {};
    const config::Screen screen = screenOf(canvas.surface);
    return {screen.width * 1000, screen.height * 1000};
}

Result<PlannedCanvas> planCanvas(const compound::LoadedConfig& loaded, const PlanOptions& options, compound::Index only,
                                 int nodesBefore) {
    const ConfigSource source{loaded.resolved, loaded.diagnostics.file()};
    PlannedCanvas planned;
    SessionPlan& plan = planned.plan;

    auto input = chooseLayouts(source, options);
    if (!input) return input.error();
    placeMonitors(source.config, *input);
    ConfigDraws gathered = gatherDraws(source, *input, plan);
    planned.copies = joined(gathered.copies);
    std::vector<ConfigDraw>& draws = gathered.draws;
    auto choice = chooseCanvas(source, options.canvas, only, draws);
    if (!choice) return choice.error();
    planned.choice = std::move(*choice);
    followFrames(source, draws, plan);
    if (draws.empty())
        return Error{source.file + ": no channel draws: it has no canvas with segments, or no compound with channels; "
                                   "see mural config print --resolved"};
    if (auto done = placeParts(source, draws, plan); !done) return done.error();
    chooseProjection(source, options.projection, draws, plan);
    auto channels = placeNodes(source, options, draws, plan);
    if (!channels) return channels.error();
    placeWindows({source, input->sizes, *channels, gathered.barriers, options.allLocal}, plan);
    takeObserver(source.config, draws, plan);
    if (planned.choice.canvas != config::kNone)
        plan.size = millimetresOf(source.config.canvases[config::at(planned.choice.canvas)]);
    explainNodes(source, *channels, nodesBefore, plan);
    plan.balance = std::make_shared<BalancePlan>(BalancePlan{
        source.config, std::move(*input), canvasSize(source.config, planned.choice.canvas), options.balance, {}});
    return planned;
}

} // namespace mural
