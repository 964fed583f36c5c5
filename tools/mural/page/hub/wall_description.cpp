#include "tools/mural/page/hub/wall_description.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <unistd.h>

#include "balancer/compound/load_config.hpp"
#include "balancer/config/eqc/parser.hpp"
#include "balancer/config/eqc/writer.hpp"
#include "balancer/svg/config_drawing.hpp"
#include "nodes/head/planning/config_plan.hpp"
#include "nodes/head/planning/make_plan.hpp"
#include "nodes/head/planning/preset_plan.hpp"
#include "nodes/session/plan_fields.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;
using config::at;

constexpr double kMmPerPixel = 25.4 / 96; // of walls whose size nobody has given

struct Place {
    double width = 0, height = 0;
    // Returns a part as x, y, width, height from the upper left corner.
    [[nodiscard]] Json of(const Viewport& part) const {
        const auto rounded = [](double value) { return std::round(value * 100) / 100; };
        return {rounded(part.x * width), rounded((1 - part.y - part.h) * height), rounded(part.w * width),
                rounded(part.h * height)};
    }
    [[nodiscard]] Json size() const { return {width, height}; }
};

double lengthOf(const Vector3& from, const Vector3& to) {
    return std::hypot(to.x - from.x, to.y - from.y, to.z - from.z);
}

Place millimetresOf(const config::ProjectionSurface& surface) {
    constexpr double kMmPerMetre = 1000;
    if (const auto* wall = std::get_if<config::Wall>(&surface))
        return {lengthOf(wall->bottomLeft, wall->bottomRight) * kMmPerMetre,
                lengthOf(wall->bottomLeft, wall->topLeft) * kMmPerMetre};
    const auto& projection = std::get<config::Projection>(surface);
    const auto side = [&](double degrees) {
        return 2 * projection.distance * std::tan(degrees * std::numbers::pi / 360) * kMmPerMetre;
    };
    return {side(projection.fov.x), side(projection.fov.y)};
}

Json segmentOf(const std::string& name, const Json& node, const std::string& channel, const Viewport& part,
               const Place& mm, const Place& px) {
    return {{"name", name}, {"rectMm", mm.of(part)}, {"turn", 0},
            {"node", node}, {"channel", channel},    {"rectPx", px.of(part)}};
}

std::string hostOfPage() {
    char name[256] = {};
    return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

Result<SessionConfig> sessionOf(const Json& options) {
    if (!options.is_object()) return Error{"the head sent an invalid plan"};
    return withPlanFields({}, options);
}

// Returns the number of the first node that draws for a channel; null: none.
Json nodeOf(const SessionPlan& plan, config::Index channel) {
    for (const NodePlan& node : plan.nodes)
        if (!node.isVacant && node.task && node.task->destination == channel) return node.node;
    return nullptr;
}

Json canvasOf(const config::ResolvedConfig& c, const config::ResolvedCanvas& canvas, const SessionPlan& plan,
              const SessionConfig& session, Place px) {
    const Place mm = millimetresOf(canvas.surface);
    if (px.width <= 0) px = {mm.width / kMmPerPixel, mm.height / kMmPerPixel};
    Json layouts = Json::array();
    for (const config::Index layout : canvas.layouts)
        layouts.push_back(layout == config::kNone ? "off" : c.layouts[at(layout)].name);
    Json active = layouts.empty() ? Json() : layouts.front();
    for (const std::string& name : session.layouts)
        if (std::ranges::find(layouts, Json(name)) != layouts.end()) active = name;
    Json segments = Json::array();
    for (const config::Index index : canvas.segments) {
        const config::ResolvedSegment& segment = c.segments[at(index)];
        Json node = nullptr;
        for (size_t i = 0; i < c.channels.size() && node.is_null(); ++i)
            if (c.channels[i].segment == index) node = nodeOf(plan, static_cast<config::Index>(i));
        segments.push_back(segmentOf(segment.name, node,
                                     segment.channel == config::kNone ? "" : c.channels[at(segment.channel)].name,
                                     segment.viewport, mm, px));
    }
    return {{"name", canvas.name}, {"layout", active},    {"layouts", layouts},
            {"sizeMm", mm.size()}, {"sizePx", px.size()}, {"segments", segments}};
}

Viewport areaOf(const NodePlan& node, const SessionConfig& session) {
    if (node.shown) return *node.shown;
    if (node.area) return *node.area;
    const double columns = session.columns, rows = session.rows;
    return {node.region.column / columns, node.region.row / rows, node.region.columns / columns,
            node.region.rows / rows};
}

// Sessions without a file have one canvas, with a segment for each part that one or several nodes draw.
Json canvasOfTiles(const SessionPlan& plan, const SessionConfig& session, Place px) {
    const Place mm{px.width * kMmPerPixel, px.height * kMmPerPixel};
    Json segments = Json::array();
    std::vector<Viewport> parts;
    for (const NodePlan& node : plan.nodes) {
        const Viewport part = areaOf(node, session);
        if (node.isVacant || node.canvas != 0 || std::ranges::find(parts, part) != parts.end()) continue;
        parts.push_back(part);
        segments.push_back(segmentOf("segment " + std::to_string(parts.size()), node.node, "", part, mm, px));
    }
    return {{"name", "wall"},      {"layout", nullptr},   {"layouts", Json::array()},
            {"sizeMm", mm.size()}, {"sizePx", px.size()}, {"segments", segments}};
}

Result<compound::LoadedConfig> loadFileOf(const SessionConfig& session) {
    auto loaded = compound::loadConfig(session.configFile, compound::processEnvironment);
    if (!loaded.ok()) return Error{session.configFile + " has errors now; check it with mural config check"};
    return loaded;
}

} // namespace

Result<Json> wallDescription(const Json& options, int width, int height) {
    auto session = sessionOf(options);
    if (!session) return session.error();
    auto plan = makePlan(*session, hostOfPage());
    if (!plan) return plan.error();
    Json canvases = Json::array();
    if (session->configFile.empty()) {
        constexpr double kUsualWidth = 1920, kUsualHeight = 1080; // until somebody looks
        canvases.push_back(
            canvasOfTiles(*plan, *session, {width > 0 ? width : kUsualWidth, height > 0 ? height : kUsualHeight}));
    } else {
        auto loaded = loadFileOf(*session);
        if (!loaded) return loaded.error();
        const compound::PixelSize wall =
            wallSizeOf(*loaded, {hostOfPage(), session->allLocal, session->canvas, session->layouts,
                                 session->projection, session->modelUnit, 0, session->balance});
        bool isFirst = true; // the size is that of the first canvas that shows something
        for (const config::ResolvedCanvas& canvas : loaded->resolved.canvases) {
            const bool isShown = plan->canvas.empty() ? isFirst : canvas.name == plan->canvas;
            const Place px = isShown ? Place{static_cast<double>(wall.w), static_cast<double>(wall.h)} : Place{};
            canvases.push_back(canvasOf(loaded->resolved, canvas, *plan, *session, px));
            isFirst = false;
        }
    }
    return Json{{"canvases", std::move(canvases)}, {"program", {{"size", {width, height}}}}};
}

Result<std::string> configText(const Json& options) {
    auto session = sessionOf(options);
    if (!session) return session.error();
    if (!session->configFile.empty()) {
        config::Diagnostics ignored(session->configFile);
        return config::writeConfig(config::readConfigFile(session->configFile, ignored));
    }
    auto form = presetOf(*session);
    if (!form) return form.error();
    auto file = config::shortForm(*form);
    if (!file) return file.error();
    return config::writeConfig(*file);
}

Result<std::string> configDrawing(const Json& options) {
    auto session = sessionOf(options);
    if (!session) return session.error();
    if (!session->configFile.empty()) {
        auto loaded = loadFileOf(*session);
        if (!loaded) return loaded.error();
        return drawing::drawConfig(loaded->resolved, loaded->resolved.name, loaded->file.heading);
    }
    auto form = presetOf(*session);
    if (!form) return form.error();
    auto file = config::shortForm(*form);
    if (!file) return file.error();
    const auto loaded = compound::loadConfig(*file, "wall.eqc", compound::processEnvironment);
    return drawing::drawConfig(loaded.resolved, "wall", loaded.file.heading);
}

} // namespace mural::page
