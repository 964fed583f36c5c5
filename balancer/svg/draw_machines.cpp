// Draws nodes with their pipes, windows and channels as nested boxes.
#include <algorithm>
#include <fmt/format.h>

#include "balancer/svg/sections.hpp"

namespace mural::drawing {

namespace {

constexpr double kChannelHeight = 22, kWindowHead = 17, kPipeHead = 18, kNodeHead = 24, kPad = 7;

// Returns the channels of the file. Destination channels would cover them.
std::vector<Index> namedChannels(const ResolvedConfig& config, const config::ResolvedWindow& w) {
    std::vector<Index> all;
    for (const Index c : w.channels) {
        if (!config.channels[at(c)].isDestination()) all.push_back(c);
    }
    return all;
}

std::string windowText(const config::ResolvedWindow& w) {
    std::string text = w.name.empty() ? "window" : w.name;
    if (config::inPixels(w.viewport)) text += fmt::format(" {:.0f}x{:.0f}", w.viewport.w, w.viewport.h);
    if (w.attributes.hintDrawable == config::value::kFbo)
        text += " off screen";
    else if (w.attributes.hintFullscreen == config::value::kOn)
        text += " full screen";
    return text;
}

std::string pipeText(const config::ResolvedPipe& p, size_t number) {
    std::string text = nameOr(p.name, "pipe", number);
    if (p.port)
        text += fmt::format(", display :{}{}", *p.port, p.device ? fmt::format(".{}", *p.device) : "");
    else if (p.device)
        text += fmt::format(", device {}", *p.device);
    return text;
}

double heightOfPipe(const ResolvedConfig& config, const config::ResolvedPipe& p) {
    double h = kPipeHead + kPad;
    for (const Index w : p.windows) {
        const auto channels = static_cast<double>(namedChannels(config, config.windows[at(w)]).size());
        h += kWindowHead + channels * (kChannelHeight + 3) + kPad + 4;
    }
    return h;
}

void drawPipe(Svg& svg, const ResolvedConfig& config, Index index, size_t number, const Box& box) {
    const config::ResolvedPipe& p = config.pipes[at(index)];
    svg.rect(box, {.fill = "#ffffff", .stroke = "#9aa5b1", .rounding = 4, .dash = {}});
    svg.text({box.x + kPad, box.y + 13}, pipeText(p, number), {10, "#1f2933", true, Align::Left}, box.w - 2 * kPad);
    double y = box.y + kPipeHead;
    for (const Index w : p.windows) {
        const config::ResolvedWindow& window = config.windows[at(w)];
        const auto channels = namedChannels(config, window);
        const Box inner{box.x + kPad, y, box.w - 2 * kPad,
                        kWindowHead + static_cast<double>(channels.size()) * (kChannelHeight + 3) + 4};
        const bool offScreen = window.attributes.hintDrawable == config::value::kFbo;
        svg.rect(inner, {.fill = offScreen ? "#f5f7fa" : "#e4ecf4",
                         .stroke = "#b8c4d0",
                         .rounding = 3,
                         .dash = offScreen ? "3 2" : ""});
        svg.text({inner.x + 6, inner.y + 12}, windowText(window), {9, "#52606d", false, Align::Left}, inner.w - 12);
        double cy = inner.y + kWindowHead;
        for (const Index c : channels) {
            svg.rect({inner.x + 5, cy, inner.w - 10, kChannelHeight - 1},
                     {.fill = paleNodeColor(colorIndex(config, index)),
                      .stroke = nodeColor(colorIndex(config, index)),
                      .rounding = 3,
                      .dash = {}});
            svg.text({inner.x + inner.w / 2, cy + 14.5},
                     nameOr(config.channels[at(c)].name, "channel", static_cast<size_t>(c)),
                     {10.5, "#111820", false, Align::Middle}, inner.w - 18);
            cy += kChannelHeight + 3;
        }
        y = inner.bottom() + kPad;
    }
}

} // namespace

Box drawMachines(Svg& svg, const ResolvedConfig& config, Point corner, double width) {
    constexpr double kPipeWidth = 168;
    double x = corner.x, y = corner.y, lowest = corner.y, right = corner.x;
    for (size_t n = 0; n < config.nodes.size(); ++n) {
        const config::ResolvedNode& node = config.nodes[n];
        // the node only runs the program
        if (node.pipes.empty() && node.isApplication && config.nodes.size() > 1) continue;
        const auto maximum = static_cast<size_t>(std::max(1., (width - kGap) / (kPipeWidth + kPad)));
        const size_t columns = std::clamp<size_t>(node.pipes.size(), 1, maximum);
        double h = kNodeHead;
        std::vector<double> rows;
        for (size_t p = 0; p < node.pipes.size(); ++p) {
            if (p % columns == 0) rows.push_back(0);
            rows.back() = std::max(rows.back(), heightOfPipe(config, config.pipes[at(node.pipes[p])]));
        }
        for (const double row : rows) h += row + kPad;
        const double w = static_cast<double>(columns) * (kPipeWidth + kPad) + kPad;
        if (x > corner.x && x + w > corner.x + width) {
            x = corner.x;
            y = lowest + kGap;
        }
        const auto index = static_cast<Index>(n);
        svg.rect({x, y, w, h + 2}, {.fill = paleNodeColor(index),
                                    .stroke = nodeColor(index),
                                    .strokeWidth = 1.5,
                                    .rounding = 6,
                                    .dash = {},
                                    .opacity = .55});
        svg.text({x + 9, y + 16}, nodeName(config, index), {11.5, nodeColor(index), true, Align::Left}, w - 18);
        double py = y + kNodeHead;
        for (size_t p = 0; p < node.pipes.size(); ++p) {
            const double px = x + kPad + static_cast<double>(p % columns) * (kPipeWidth + kPad);
            drawPipe(svg, config, node.pipes[p], p,
                     {px, py, kPipeWidth, heightOfPipe(config, config.pipes[at(node.pipes[p])])});
            if (p % columns == columns - 1) py += rows[p / columns] + kPad;
        }
        lowest = std::max(lowest, y + h + 2);
        right = std::max(right, x + w);
        x += w + kGap;
    }
    return {corner.x, corner.y, right - corner.x, lowest - corner.y};
}

} // namespace mural::drawing
