// Draws canvases with their segments, to scale, and their layouts with the views beside them.
#include <algorithm>
#include <fmt/format.h>

#include "balancer/config/screen.hpp"
#include "balancer/svg/sections.hpp"

namespace mural::drawing {

namespace {

// Returns a part of a canvas (y upwards) within its box (y downwards).
Box partOf(const Box& whole, const Viewport& part) {
    return {whole.x + part.x * whole.w, whole.y + (1 - part.y - part.h) * whole.h, part.w * whole.w, part.h * whole.h};
}

std::string eyesText(EyeSet eyes) {
    if (eyes == kAllEyes) return {};
    std::string text;
    for (const Eye eye : {Eye::Left, Eye::Right, Eye::Cyclop}) {
        if (eyes.has(eye))
            text += fmt::format("{}{}", text.empty() ? "" : ", ",
                                eye == Eye::Left    ? "left"
                                : eye == Eye::Right ? "right"
                                                    : "cyclop");
    }
    return text + (text.find(',') == std::string::npos ? " eye" : " eyes");
}

std::string channelName(const ResolvedConfig& config, const config::ResolvedSegment& s) {
    return s.channel == kNone ? "no channel" : config.channels[at(s.channel)].name;
}

void drawSegment(Svg& svg, const ResolvedConfig& config, const config::ResolvedSegment& s, const Box& canvas) {
    const std::string tip = fmt::format("segment {}: channel {}, viewport {:.4g} {:.4g} {:.4g} {:.4g}", s.name,
                                        channelName(config, s), s.viewport.x, s.viewport.y, s.viewport.w, s.viewport.h);
    if (!(s.outer == s.viewport)) svg.rect(partOf(canvas, s.outer), {.fill = "#3e4c59", .dash = {}}, "bezel");
    svg.rect(
        partOf(canvas, s.viewport),
        {.fill = paleColorOf(config, s.channel), .stroke = colorOf(config, s.channel), .strokeWidth = 1.5, .dash = {}},
        tip);
}

// Segments of the two eyes coincide, so their names are stacked.
void nameSegment(Svg& svg, const ResolvedConfig& config, const config::ResolvedSegment& s, const Box& canvas,
                 size_t stacked) {
    const Box seen = partOf(canvas, s.viewport);
    const double middle = seen.y + seen.h / 2 + static_cast<double>(stacked) * 30;
    svg.text({seen.x + seen.w / 2, middle}, channelName(config, s), {12, "#111820", true, Align::Middle}, seen.w - 6);
    std::string text = s.channel == kNone ? "" : nodeName(config, config.pipeOf(config.channels[at(s.channel)]).node);
    if (const std::string eyes = eyesText(s.eyes); !eyes.empty()) text += (text.empty() ? "" : " · ") + eyes;
    if (!s.copies.empty()) text += " · copied to " + config.channels[at(s.copies.front())].name;
    if (s.copies.size() > 1) text += fmt::format(" and {} more", s.copies.size() - 1);
    svg.text({seen.x + seen.w / 2, middle + 14}, text, {9.5, "#52606d", false, Align::Middle}, seen.w - 6);
}

double aspectOf(const config::ResolvedCanvas& c) {
    const config::Screen screen = config::screenOf(c.surface);
    return std::clamp(screen.usable() ? screen.width / screen.height : 1.6, .3, 5.);
}

void drawLayout(Svg& svg, const ResolvedConfig& config, const config::ResolvedCanvas& c, Index layout, const Box& box) {
    svg.rect(box, {.fill = layout == kNone ? "#323f4b" : "#f5f7fa", .stroke = "#9aa5b1", .dash = {}});
    for (const Index s : c.segments)
        svg.rect(partOf(box, config.segments[at(s)].viewport), {.stroke = "#cbd2d9", .dash = {}});
    if (layout == kNone) return;
    const config::ResolvedLayout& l = config.layouts[at(layout)];
    for (size_t i = 0; i < l.views.size(); ++i) {
        const config::ResolvedView& v = config.views[at(l.views[i])];
        const Box part = partOf(box, v.viewport);
        const Style style{
            .fill = "#ffd166", .stroke = "#b7791f", .rounding = 2, .dash = v.surface ? "" : "3 2", .opacity = .55};
        svg.rect({part.x + 2, part.y + 2, part.w - 4, part.h - 4}, style,
                 v.surface ? "a view with its own wall" : "a view");
        std::string text = l.views.size() > 1 || !v.name.empty() ? nameOr(v.name, "view", i) : "";
        if (v.mode == config::ViewMode::Stereo) text += " stereo";
        svg.text({part.x + part.w / 2, part.y + part.h / 2 + 3}, text, {9, "#5c3c00", false, Align::Middle},
                 part.w - 6);
    }
}

} // namespace

Box drawDisplays(Svg& svg, const ResolvedConfig& config, Point corner, double width) {
    constexpr double kCanvasHeight = 230, kCanvasWidth = 560, kSmall = 118;
    double y = corner.y, right = corner.x;
    for (size_t i = 0; i < config.canvases.size(); ++i) {
        const config::ResolvedCanvas& c = config.canvases[i];
        const double aspect = aspectOf(c);
        const double w = std::min(kCanvasWidth, kCanvasHeight * aspect), h = w / aspect;
        const config::Screen screen = config::screenOf(c.surface);
        svg.text({corner.x, y + 8},
                 fmt::format("canvas {}, {:.3g} x {:.3g} m", nameOr(c.name, "", i), screen.width, screen.height),
                 {11, "#52606d", false, Align::Left});
        const Box box{corner.x, y + 18, w, h};
        svg.rect(box, {.fill = "#f0f2f5", .stroke = "#7b8794", .dash = "5 3"});
        for (const Index s : c.segments) drawSegment(svg, config, config.segments[at(s)], box);
        for (size_t s = 0; s < c.segments.size(); ++s) {
            const config::ResolvedSegment& segment = config.segments[at(c.segments[s])];
            const auto stacked =
                std::count_if(c.segments.begin(), c.segments.begin() + static_cast<std::ptrdiff_t>(s),
                              [&](Index other) { return config.segments[at(other)].viewport == segment.viewport; });
            nameSegment(svg, config, segment, box, static_cast<size_t>(stacked));
        }
        double x = box.right() + 34, top = y + 18, lowest = box.bottom();
        svg.text({x, y + 8}, c.layouts.size() == 1 ? "layout" : "layouts; the first one is shown at the start",
                 {11, "#52606d", false, Align::Left});
        const double smallHeight = std::min(kSmall / aspect, 90.);
        for (size_t l = 0; l < c.layouts.size(); ++l) {
            if (x + kSmall > corner.x + width) {
                x = box.right() + 34;
                top += smallHeight + 30;
            }
            drawLayout(svg, config, c, c.layouts[l], {x, top, smallHeight * aspect, smallHeight});
            const std::string name = c.layouts[l] == kNone ? "off"
                                                           : nameOr(config.layouts[at(c.layouts[l])].name, "layout",
                                                                    static_cast<size_t>(c.layouts[l]));
            svg.text({x, top + smallHeight + 13}, name, {10, "#1f2933", l == 0, Align::Left}, kSmall);
            lowest = std::max(lowest, top + smallHeight + 18);
            x += kSmall + kGap;
            right = std::max(right, x);
        }
        y = lowest + 26;
    }
    return {corner.x, corner.y, right - corner.x, y - corner.y - 20};
}

} // namespace mural::drawing
