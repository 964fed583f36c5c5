#include "tools/mural/accuracy/plot/cost_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "tools/mural/accuracy/plot/plot_colors.hpp"

namespace mural::cli {

namespace {

using drawing::Align;
using drawing::Box;
using drawing::Point;
using drawing::Style;
using drawing::Svg;

// relative to 255; column of exact results; room for numbers
constexpr double kMinError = 1e-3, kMaxError = 100, kExact = 60, kAxis = 40;
constexpr std::array<const char*, 8> kColours{"#1f6f8b", "#c46a1b", "#5b8c2a", "#8e3b8a",
                                              "#b8312f", "#2f4b8f", "#8a7a1d", "#3f3f46"};

struct Plot {
    Box area;
    double minimum, maximum; // range of the vertical axis, powers of ten

    [[nodiscard]] double x(double error) const {
        if (error <= 0) return area.x + kAxis + kExact / 2;
        const double left = area.x + kAxis + kExact;
        return left + (area.x + area.w - left) * std::log(std::clamp(error, kMinError, kMaxError) / kMinError) /
                          std::log(kMaxError / kMinError);
    }
    [[nodiscard]] double y(double value) const {
        return area.y + area.h -
               area.h * std::log(std::clamp(value, minimum, maximum) / minimum) / std::log(maximum / minimum);
    }
};

void drawFrame(Svg& svg, const Plot& p, const std::string& title) {
    Style faint, column;
    faint.stroke = kGridColor;
    faint.dash = "2 3";
    column.fill = "#eef6ee";
    svg.text({p.area.x, p.area.y - 24}, title, {.size = 12, .color = kTextColor, .bold = true});
    svg.rect({p.area.x + kAxis, p.area.y, kExact, p.area.h}, column);
    svg.text({p.area.x + kAxis + kExact / 2, p.area.y + p.area.h + 14}, "equal",
             {.size = 10, .color = kTextColor, .align = Align::Middle});
    for (double v = p.minimum; v <= p.maximum * 1.01; v *= 10) {
        svg.line({p.area.x + kAxis, p.y(v)}, {p.area.x + p.area.w, p.y(v)}, faint);
        svg.text({p.area.x + kAxis - 5, p.y(v) + 3}, fmt::format("{:g}", v),
                 {.size = 10, .color = kTextColor, .align = Align::Right});
    }
    for (double v = kMinError; v <= kMaxError * 1.01; v *= 10) {
        svg.line({p.x(v), p.area.y}, {p.x(v), p.area.y + p.area.h}, faint);
        svg.text({p.x(v), p.area.y + p.area.h + 14}, fmt::format("{:g}", v),
                 {.size = 10, .color = kTextColor, .align = Align::Middle});
    }
    svg.text({p.area.x + (p.area.w + kAxis) / 2, p.area.y + p.area.h + 30}, "root mean square error, of 255",
             {.size = 11, .color = kMinorTextColor, .align = Align::Middle});
}

// Short label: the text after a colon, up to the first comma.
std::string labelOf(const std::string& what) {
    const size_t colon = what.find(": ");
    const std::string own = colon == std::string::npos ? what : what.substr(colon + 2);
    return own.substr(0, own.find(','));
}

void drawDots(Svg& svg, const Plot& p, const AccuracyReport& report, double Cost::*value,
              const std::map<std::string, size_t>& groups) {
    std::vector<Box> taken; // areas of labels
    for (const AccuracyRow& row : report.rows) {
        if (!row.cost || !row.failure.empty() || (*row.cost).*value <= 0) continue;
        const char* colour = kColours[groups.at(row.group) % kColours.size()];
        const double error = row.error.rootMeanSquare();
        const Point at{p.x(error), p.y((*row.cost).*value)};
        Style dot;
        dot.fill = colour;
        dot.rounding = 4;
        svg.rect({at.x - 4, at.y - 4, 8, 8}, dot,
                 fmt::format("{}: {}; error {:.3g}, {:.3g} ns and {:.3g} bytes per pixel", row.group, row.what, error,
                             row.cost->cpuNs, row.cost->bytes));
        if (error <= 0) continue; // too dense for labels; tooltips identify them
        const std::string label = labelOf(row.what);
        Box box{at.x + 6, at.y - 5, Svg::widthOf(label, 9), 10};
        if (box.x + box.w > p.area.x + p.area.w) box.x = at.x - 6 - box.w;
        const auto overlaps = [&](const Box& other) {
            return box.x < other.x + other.w && other.x < box.x + box.w && box.y < other.y + other.h &&
                   other.y < box.y + box.h;
        };
        if (std::ranges::any_of(taken, overlaps)) continue;
        taken.push_back(box);
        svg.text({box.x, box.y + 8}, label, {.size = 9, .color = colour});
    }
}

} // namespace

double drawCosts(Svg& svg, const AccuracyReport& report, const Box& area) {
    std::map<std::string, size_t> groups;
    std::vector<std::string> inOrder;
    for (const AccuracyRow& row : report.rows)
        if (row.cost && groups.emplace(row.group, groups.size()).second) inOrder.push_back(row.group);
    if (groups.empty()) return area.y;
    svg.text({area.x, area.y}, "Cost of the errors", {.size = 15, .color = kTextColor, .bold = true});
    double y = area.y + 20;
    for (const std::string& group : inOrder) {
        Style dot;
        dot.fill = kColours[groups[group] % kColours.size()];
        dot.rounding = 4;
        const size_t i = groups[group];
        const Point at{area.x + static_cast<double>(i % 3) * area.w / 3, y + static_cast<double>(i / 3) * 16};
        svg.rect({at.x, at.y - 8, 8, 8}, dot);
        svg.text({at.x + 13, at.y}, group, {.size = 11, .color = kTextColor}, area.w / 3 - 20);
    }
    y += static_cast<double>((inOrder.size() + 2) / 3) * 16 + 36;
    const double width = (area.w - 30) / 2;
    const std::pair<const char*, double Cost::*> plots[] = {{"CPU time against error, ns per pixel", &Cost::cpuNs},
                                                            {"bytes against error, per pixel", &Cost::bytes}};
    for (size_t i = 0; i < 2; ++i) {
        double minimum = 1e9, maximum = 1e-9;
        for (const AccuracyRow& row : report.rows)
            if (row.cost && (*row.cost).*plots[i].second > 0) {
                minimum = std::min(minimum, (*row.cost).*plots[i].second);
                maximum = std::max(maximum, (*row.cost).*plots[i].second);
            }
        const Plot p{{area.x + static_cast<double>(i) * (width + 30), y, width, area.h},
                     std::pow(10, std::floor(std::log10(minimum))),
                     std::pow(10, std::ceil(std::log10(maximum * 1.001)))};
        drawFrame(svg, p, plots[i].first);
        drawDots(svg, p, report, plots[i].second, groups);
    }
    return y + area.h + 36;
}

} // namespace mural::cli
