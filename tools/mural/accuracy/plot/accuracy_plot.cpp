#include "tools/mural/accuracy/plot/accuracy_plot.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "balancer/svg/svg.hpp"
#include "tools/mural/accuracy/accuracy_text.hpp"
#include "tools/mural/accuracy/plot/cost_plot.hpp"
#include "tools/mural/accuracy/plot/plot_colors.hpp"

namespace mural::cli {

namespace {

using drawing::Align;
using drawing::Box;
using drawing::Point;
using drawing::Style;
using drawing::Svg;

constexpr double kPlotWidth = 1080, kLabels = 330, kNone = 60, kPlot = 440; // column of exact results, then the scale
constexpr double kLeft = kLabels + kNone, kRight = kLeft + kPlot;
constexpr double kTop = 118, kRow = 17, kHeading = 26;
constexpr double kMin = 1e-3, kMax = 255;
const char *const kGood = "#1f6f8b", *const kBad = "#c0392b";

double placeOf(double value) {
    return kLeft + kPlot * std::log(std::clamp(value, kMin, kMax) / kMin) / std::log(kMax / kMin);
}

Style filled(const char* colour, double rounding) {
    Style style;
    style.fill = colour;
    style.rounding = rounding;
    return style;
}
Style stroked(const char* colour, double width, const char* dash = "") {
    Style style;
    style.stroke = colour;
    style.strokeWidth = width;
    style.dash = dash;
    return style;
}
Style ringed(const char* colour) {
    Style style = filled("#ffffff", 4);
    style.stroke = colour;
    style.strokeWidth = 1.6;
    return style;
}

Box around(Point at, double radius) { return {at.x - radius, at.y - radius, 2 * radius, 2 * radius}; }

void drawPromise(Svg& svg, double x, double y, bool ofRing) {
    svg.line({x, y - 6}, {x, y + 6}, stroked(kBad, 2, ofRing ? "2 2" : ""));
}
void drawDot(Svg& svg, Point at, const char* colour, const std::string& tip) {
    svg.rect(around(at, 4.5), filled(colour, 4.5), tip);
}
void drawRing(Svg& svg, Point at, const char* colour) { svg.rect(around(at, 4), ringed(colour)); }

void drawHead(Svg& svg, const AccuracyReport& report, double bottom) {
    svg.text({16, 28}, "Error of Mural's pictures against the reference",
             {.size = 18, .color = kTextColor, .bold = true});
    svg.text({16, 47}, report.subject + (report.gl.empty() ? "" : "; " + report.gl),
             {.size = 11, .color = kMinorTextColor}, kPlotWidth - 32);
    drawDot(svg, {22, 66}, kGood, "");
    svg.text({32, 70}, "largest error of any colour value", {.size = 11, .color = kTextColor});
    drawRing(svg, {240, 66}, kGood);
    svg.text({250, 70}, "root mean square error", {.size = 11, .color = kTextColor});
    drawPromise(svg, 404, 66, false);
    svg.text({412, 70}, "bound of the largest error", {.size = 11, .color = kTextColor});
    drawPromise(svg, 578, 66, true);
    svg.text({586, 70}, "bound of the root mean square error (as PSNR)", {.size = 11, .color = kTextColor});
    svg.text({(kLeft + kRight) / 2, 92}, "error, in steps of 1/255 of full brightness (logarithmic)",
             {.size = 11, .color = kMinorTextColor, .align = Align::Middle});
    svg.rect({kLabels, 98, kNone, bottom - 98}, filled("#eef6ee", 0));
    svg.text({kLabels + kNone / 2, 110}, "equal", {.size = 10, .color = kTextColor, .align = Align::Middle});
    for (const double tick : {0.001, 0.01, 0.1, 1.0, 10.0, 100.0, 255.0}) {
        svg.line({placeOf(tick), 114}, {placeOf(tick), bottom}, stroked(kGridColor, 1, tick == 1 ? "" : "2 3"));
        svg.text({placeOf(tick), 110}, fmt::format("{:g}", tick),
                 {.size = 10, .color = kTextColor, .align = Align::Middle});
    }
    svg.text({kRight + 18, 110}, "differing pixels", {.size = 10, .color = kTextColor});
}

std::string shareText(const MeasuredError& e) {
    if (e.differing == 0) return "none of " + spaced(e.pixels);
    return fmt::format("{:.3g} % of {}", 100 * e.differingShare(), spaced(e.pixels));
}

void drawRow(Svg& svg, const AccuracyRow& row, double y) {
    const char* colour = row.holds() ? kGood : kBad;
    svg.text({28, y + 4}, row.what, {.size = 11, .color = row.holds() ? kTextColor : kBad}, kLabels - 34);
    if (!row.failure.empty())
        return svg.text({kLeft, y + 4}, "failed: " + row.failure, {.size = 11, .color = kBad}, kPlotWidth - kLeft - 10);
    const auto at = [&](double value) { return Point{value > 0 ? placeOf(value) : kLabels + kNone / 2, y}; };
    const double usual = row.error.rootMeanSquare();
    const std::string tip = fmt::format("{}, against {}: largest {:.3g}, root mean square {:.3g}; bound: {}", row.what,
                                        row.reference, row.error.largest, usual, row.bound.text());
    if (row.bound.largest) drawPromise(svg, placeOf(*row.bound.largest), y, false);
    if (row.bound.psnr) drawPromise(svg, placeOf(255 / std::pow(10, *row.bound.psnr / 20)), y, true);
    if (usual > 0) {
        svg.line(at(usual), at(row.error.largest), stroked(colour, 1));
        drawRing(svg, at(usual), colour);
    }
    drawDot(svg, at(row.error.largest), colour, tip);
    svg.text({kRight + 18, y + 4}, shareText(row.error), {.size = 10, .color = kMinorTextColor});
}

} // namespace

std::string plotOf(const AccuracyReport& report) {
    double height = kTop;
    std::string group;
    for (const AccuracyRow& row : report.rows)
        height += kRow + (std::exchange(group, row.group) != row.group ? kHeading : 0);
    Svg svg;
    drawHead(svg, report, height + 4);
    double y = kTop;
    group.clear();
    for (const AccuracyRow& row : report.rows) {
        if (row.group != group) {
            group = row.group;
            y += kHeading;
            svg.text({16, y - 6}, group, {.size = 12, .color = kTextColor, .bold = true});
        }
        drawRow(svg, row, y + kRow / 2 - 2);
        y += kRow;
    }
    const double below = drawCosts(svg, report, {16, height + 40, kPlotWidth - 32, 330});
    return svg.finish(kPlotWidth, std::max(height + 16, below + 16));
}

} // namespace mural::cli
