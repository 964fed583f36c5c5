#include "nodes/head/planning/config/projection_choice.hpp"

#include <algorithm>
#include <set>

#include "balancer/compound/frusta.hpp"

namespace mural {
namespace {

using compound::RenderContext;
using config::at;
using config::Index;
using config::kNone;

// True if some screen has another orientation than the first.
bool standAtAngles(const std::vector<ConfigDraw>& draws) {
    const auto normal = [](const RenderContext& c) {
        return transformDirection(rigidInverse(c.perspectiveHead), {0, 0, 1});
    };
    return std::ranges::any_of(
        draws, [&](const ConfigDraw& d) { return dot(normal(d.context), normal(draws.front().context)) < 1 - 1e-6; });
}

ScreenView screenOf(const config::ResolvedConfig& config, const RenderContext& c) {
    const Frustum& f = c.destinationPerspective;
    const double n = f.nearPlane;
    const Viewport area =
        compose(config.views[at(c.view)].viewport, compound::coverage(config, config.channels[at(c.destination)]));
    return ScreenView{area, f.left / n, f.right / n, f.bottom / n, f.top / n, c.perspectiveHead};
}

} // namespace

void chooseProjection(const ConfigSource& source, ProjectionChoice choice, std::vector<ConfigDraw>& draws,
                      SessionPlan& plan) {
    const bool atAngles = standAtAngles(draws);
    const bool inRoom = choice == ProjectionChoice::Room || (choice == ProjectionChoice::Auto && atAngles);
    if (inRoom)
        plan.explain.push_back(
            std::string(atAngles ? "its screens stand at angles to each other: " : "") +
            "each screen shows the scene from the observer's eyes (--projection program: one flat picture)");
    else if (atAngles)
        plan.explain.push_back("its screens stand at angles to each other, but show the program's picture as one flat "
                               "wall (--projection program)");
    if (!inRoom) return;
    std::set<Index> behind;
    for (ConfigDraw& d : draws) {
        if (!d.context.behindScreen) {
            d.screen = screenOf(source.config, d.context);
        } else if (behind.insert(d.context.destination).second) {
            plan.warnings.push_back(source.file + ": the observer's eyes are behind the screen of channel \"" +
                                    source.channelName(d.context.destination) +
                                    "\"; it shows its part of the program's own picture");
        }
    }
}

void takeObserver(const config::ResolvedConfig& config, const std::vector<ConfigDraw>& draws, SessionPlan& plan) {
    for (const ConfigDraw& d : draws) {
        const Index o = config.views[at(d.context.view)].observer;
        if (d.context.eye == Eye::Cyclop || o == kNone) continue;
        const config::ResolvedObserver& observer = config.observers[at(o)];
        plan.eyeBase = length(observer.eyeRight - observer.eyeLeft);
        plan.focusDistance = observer.focusDistance;
        return;
    }
}

} // namespace mural
