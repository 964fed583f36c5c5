#include "balancer/svg/config_drawing.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "balancer/svg/sections.hpp"

namespace mural::drawing {

namespace {

constexpr double kWidth = 1500;
constexpr double kMargin = 28;

struct Colors {
    const char* strong;
    const char* pale;
};

// Palette for colour-blind readers (Okabe and Ito, "Color Universal Design").
constexpr auto kColors = std::to_array<Colors>({
    {"#0072b2", "#d6e8f4"},
    {"#d55e00", "#fae0cd"},
    {"#009e73", "#d3efe6"},
    {"#a5539a", "#f1dfee"},
    {"#b8860b", "#f8eccb"},
    {"#2f9fd8", "#dbf0fb"},
    {"#6b6b6b", "#e6e6e6"},
    {"#8c564b", "#ecdfdc"},
    {"#5b5bd6", "#e1e1fa"},
    {"#4f7f1f", "#e2edd5"},
});

const Colors& colors(Index node) { return kColors[static_cast<size_t>(std::max<Index>(0, node)) % kColors.size()]; }

constexpr Index kGrey = 6;

} // namespace

std::string nodeColor(Index node) { return colors(node).strong; }
std::string paleNodeColor(Index node) { return colors(node).pale; }
// Colours distinguish machines, or the GPUs of a single machine.
Index colorIndex(const ResolvedConfig& config, Index pipe) {
    const auto drawing = std::count_if(config.nodes.begin(), config.nodes.end(),
                                       [](const config::ResolvedNode& n) { return !n.pipes.empty(); });
    return drawing == 1 ? pipe : config.pipes[ResolvedConfig::at(pipe)].node;
}

Index channelColor(const ResolvedConfig& config, Index channel) {
    if (channel == kNone) return kGrey;
    return colorIndex(config,
                      config.windows[ResolvedConfig::at(config.channels[ResolvedConfig::at(channel)].window)].pipe);
}

std::string colorOf(const ResolvedConfig& config, Index channel) { return nodeColor(channelColor(config, channel)); }
std::string paleColorOf(const ResolvedConfig& config, Index channel) {
    return paleNodeColor(channelColor(config, channel));
}

std::string nameOr(const std::string& name, std::string_view otherwise, size_t number) {
    return name.empty() ? fmt::format("{} {}", otherwise, number) : name;
}

std::string nodeName(const ResolvedConfig& config, Index node) {
    const config::ResolvedNode& n = config.nodes[ResolvedConfig::at(node)];
    const std::string own = !n.name.empty() ? n.name : n.host;
    if (n.isApplication) return own.empty() ? "application" : "application: " + own;
    return own.empty() ? fmt::format("node {}", node) : n.host.empty() || n.host == own ? own : own + " on " + n.host;
}

std::string drawConfig(const ResolvedConfig& config, const std::string& title,
                       const std::vector<std::string>& heading) {
    Svg svg;
    constexpr double kMax = kWidth - 2 * kMargin;
    double y = kMargin + 14, width = 640;
    const auto drawText = [&](const std::string& text, const Font& font) {
        svg.text({kMargin, y}, text, font, kMax);
        width = std::max(width, std::min(kMax, Svg::widthOf(text, font.size) * 1.1));
    };
    drawText(title, {20, "#111820", true, Align::Left});
    for (const std::string& line : heading) {
        y += 17;
        drawText(line, {12, "#52606d", false, Align::Left});
    }
    const auto section = [&](const char* name, Box (*draw)(Svg&, const ResolvedConfig&, Point, double)) {
        y += 38;
        svg.text({kMargin, y}, name, {14, "#111820", true, Align::Left});
        svg.line({kMargin, y + 7}, {kMargin + 240, y + 7}, {.stroke = "#cbd2d9", .dash = {}});
        const Box box = draw(svg, config, {kMargin, y + 20}, kMax);
        y = std::max(y + 20, box.bottom());
        width = std::max(width, box.w);
    };
    if (!config.canvases.empty()) section("Displays", drawDisplays);
    section("Machines", drawMachines);
    if (!config.roots.empty()) section("Compounds", drawCompounds);
    return svg.finish(width + 2 * kMargin, y + kMargin);
}

} // namespace mural::drawing
