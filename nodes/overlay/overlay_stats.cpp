// The overlay `stats`: for each node a panel with its latest frames as bars, its rate, and the means of the parts.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "nodes/overlay/overlay_font.hpp"
#include "nodes/overlay/overlay_picture.hpp"

namespace mural {

namespace {

// Sizes relative to the height of a line of text.
constexpr double kPanelWidth = 25, kLegendWidth = 9.5, kLineStep = 1.15, kMargin = 0.5;
constexpr double kHeaderLines = 2;
constexpr double kPanelHeight = (kHeaderLines + kFrameParts) * kLineStep + 2 * kMargin;
constexpr double kTextPart = 1.0 / 36; // height of text as a part of the window's
constexpr double kSmallestText = 9, kPreferredText = 13, kLargestText = 40;
constexpr OverlayColour kPanel{10, 14, 20, 215};
constexpr OverlayColour kText{255, 255, 255, 255};
constexpr OverlayColour kFaint{160, 170, 180, 255};
constexpr OverlayColour kScaleLine{90, 100, 110, 255};

// By FramePart. Distinct for most kinds of colour vision (Okabe and Ito).
constexpr std::array<OverlayColour, kFrameParts> kPartColours = {{{204, 121, 167, 255},
                                                                  {0, 158, 115, 255},
                                                                  {230, 159, 0, 255},
                                                                  {240, 228, 66, 255},
                                                                  {213, 94, 0, 255},
                                                                  {86, 180, 233, 255},
                                                                  {255, 255, 255, 255},
                                                                  {0, 114, 178, 255},
                                                                  {112, 120, 130, 255}}};

// Returns the end of a scale in ms: 1, 2 or 5 times a power of ten.
double scaleFor(double ms) {
    double scale = 1;
    for (const double factor : {2.0, 2.5, 2.0, 2.0, 2.5, 2.0, 2.0, 2.5, 2.0, 2.0, 2.5, 2.0})
        if (scale < ms) scale *= factor;
    return scale;
}

// Returns the duration that 95 % of the frames do not exceed. Bars of longer frames end at the top of the chart.
double usualMs(const FrameHistory& history) {
    std::vector<double> totals;
    for (const FrameParts& frame : history.frames()) totals.push_back(frame.totalMs());
    std::ranges::sort(totals);
    return totals.empty() ? 0 : totals[(totals.size() - 1) * 95 / 100];
}

class PanelPainter {
public:
    // left, top: corner of the panel; y grows upward.
    PanelPainter(OverlayImage& image, double text, double left, double top)
        : image_(image), text_(text), left_(left), top_(top) {}

    void paint(const OverlayNode& node) {
        const FrameHistory& history = node.frames;
        fill(left_, top_ - kPanelHeight * text_, kPanelWidth * text_, kPanelHeight * text_, kPanel);
        const double inner = left_ + kMargin * text_, right = left_ + (kPanelWidth - kMargin) * text_;
        line(0, node.name, inner, kText);
        if (history.frames().empty()) return line(1, "no frames yet", inner, kFaint);
        const std::string rate = fmt::format("{:.1f} frames/s", history.framesPerSecond());
        line(1, fmt::format("frame {}", history.frames().back().frame), inner, kText);
        line(1, rate, right - overlayTextWidth(rate, text_), kText);
        legend(history, right - kLegendWidth * text_, right);
        bars(history, inner, right - (kLegendWidth + 1) * text_);
    }

private:
    void fill(double x, double y, double w, double h, OverlayColour colour) {
        const int x0 = static_cast<int>(std::lround(x)), y0 = static_cast<int>(std::lround(y));
        image_.fill({x0, y0, static_cast<int>(std::lround(x + w)) - x0, static_cast<int>(std::lround(y + h)) - y0},
                    colour);
    }

    [[nodiscard]] double lineY(double number) const { return top_ - (kMargin + (number + 1) * kLineStep) * text_; }

    void line(double number, const std::string& text, double x, OverlayColour colour) {
        drawOverlayText(image_, text, x, lineY(number), text_, colour);
    }

    // The order of the lines is that of a bar, from above.
    void legend(const FrameHistory& history, double left, double right) {
        for (size_t i = 0; i < kFrameParts; ++i) {
            const size_t part = kFrameParts - 1 - i;
            const double number = kHeaderLines + static_cast<double>(i);
            const double ms = history.meanMs(static_cast<FramePart>(part));
            const std::string mean = fmt::format("{:.1f} ms", ms);
            fill(left, lineY(number) + 0.15 * text_, 0.7 * text_, 0.7 * text_, kPartColours[part]);
            line(number, std::string(kFramePartNames[part]), left + text_, ms > 0 ? kText : kFaint);
            line(number, mean, right - overlayTextWidth(mean, text_), ms > 0 ? kText : kFaint);
        }
    }

    void bars(const FrameHistory& history, double left, double right) {
        const double scale = scaleFor(usualMs(history));
        const double bottom = lineY(kHeaderLines + kFrameParts - 1), height = (kFrameParts * kLineStep - 0.3) * text_;
        for (const double part : {0.0, 0.5, 1.0}) fill(left, bottom + part * height, right - left, 1, kScaleLine);
        const double step = (right - left) / static_cast<double>(FrameHistory::kFrames);
        double x = right - step * static_cast<double>(history.frames().size());
        for (const FrameParts& frame : history.frames()) {
            double y = bottom;
            for (size_t part = 0; part < kFrameParts; ++part) {
                const double high = std::min(frame.ms[part] / scale * height, bottom + height - y);
                fill(x, y, step > 2 ? step - 1 : step, high, kPartColours[part]);
                y += high;
            }
            x += step;
        }
        const std::string label = fmt::format("{:g} ms", scale);
        drawOverlayText(image_, label, left, bottom + height - 0.95 * text_, 0.9 * text_, kFaint);
    }

    OverlayImage& image_;
    const double text_; // height of a line of text
    const double left_, top_;
};

struct PanelGrid {
    double text = kSmallestText;
    int columns = 1, rows = 1; // that fit
};

PanelGrid gridFor(double text, double width, double height) {
    const double gap = kMargin * text;
    return {text, static_cast<int>((width - gap) / (kPanelWidth * text + gap)),
            static_cast<int>((height - gap) / (kPanelHeight * text + gap))};
}

// Returns the largest text with which all panels fit. At the smallest size some may be missing.
PanelGrid arrange(size_t panels, int width, int height) {
    const double preferred = std::clamp(height * kTextPart, kPreferredText, kLargestText);
    for (double text = preferred; text > kSmallestText; text -= 0.5)
        if (const PanelGrid grid = gridFor(text, width, height);
            grid.columns > 0 && grid.rows > 0 &&
            static_cast<size_t>(grid.columns) * static_cast<size_t>(grid.rows) >= panels)
            return grid;
    PanelGrid grid = gridFor(kSmallestText, width, height);
    grid.columns = std::max(grid.columns, 1);
    grid.rows = std::max(grid.rows, 1);
    return grid;
}

} // namespace

void drawStats(OverlayImage& image, const OverlayContent& content) {
    if (content.nodes.empty()) return;
    const PanelGrid grid = arrange(content.nodes.size(), image.width(), image.height());
    const double gap = kMargin * grid.text;
    const size_t shown =
        std::min(content.nodes.size(), static_cast<size_t>(grid.columns) * static_cast<size_t>(grid.rows));
    for (size_t i = 0; i < shown; ++i) {
        const auto column = static_cast<double>(i % static_cast<size_t>(grid.columns));
        const auto row = static_cast<double>(i / static_cast<size_t>(grid.columns));
        PanelPainter(image, grid.text, gap + column * (kPanelWidth * grid.text + gap),
                     image.height() - gap - row * (kPanelHeight * grid.text + gap))
            .paint(content.nodes[i]);
    }
    if (shown == content.nodes.size()) return;
    drawOverlayText(image, fmt::format("{} more nodes", content.nodes.size() - shown), gap, 0, grid.text, kText);
}

} // namespace mural
