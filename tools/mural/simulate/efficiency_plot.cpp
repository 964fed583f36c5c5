#include "tools/mural/simulate/efficiency_plot.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "balancer/svg/svg.hpp"

namespace mural::cli {

namespace {

using drawing::Align;
using drawing::Font;
using drawing::Style;

constexpr double kWidth = 900, kHeight = 420;
constexpr drawing::Box kArea{60, 50, 640, 320};
constexpr const char* kColors[] = {"#9aa5b1", "#d64545", "#f0b429", "#3ebd93", "#2186eb", "#1f2933", "#8719e0"};

} // namespace

std::string efficiencyPlot(const std::string& title, const std::vector<EfficiencyCurve>& curves) {
    drawing::Svg svg;
    svg.text({kArea.x, 28}, title, Font{15, "#1f2933", true}, kWidth - kArea.x - 20);
    size_t frames = 1;
    for (const EfficiencyCurve& c : curves) frames = std::max(frames, c.values.size());
    const auto xOf = [&](size_t frame) {
        return kArea.x + kArea.w * static_cast<double>(frame) / static_cast<double>(std::max<size_t>(1, frames - 1));
    };
    const auto yOf = [&](double value) { return kArea.bottom() - kArea.h * std::clamp(value, 0., 1.); };
    const Style grid{.stroke = "#e4e7eb"};
    for (int tenth = 0; tenth <= 10; tenth += 2) {
        svg.line({kArea.x, yOf(tenth / 10.)}, {kArea.right(), yOf(tenth / 10.)}, grid);
        svg.text({kArea.x - 8, yOf(tenth / 10.) + 4}, fmt::format("{:.1f}", tenth / 10.),
                 Font{11, "#52606d", false, Align::Right});
    }
    for (int part = 0; part <= 4; ++part) {
        const size_t frame = (frames - 1) * static_cast<size_t>(part) / 4;
        svg.text({xOf(frame), kArea.bottom() + 18}, std::to_string(frame), Font{11, "#52606d", false, Align::Middle});
    }
    svg.text({kArea.x + kArea.w / 2, kArea.bottom() + 38}, "frame", Font{12, "#1f2933", false, Align::Middle});
    double y = kArea.y + 10;
    for (size_t i = 0; i < curves.size(); ++i) {
        const EfficiencyCurve& c = curves[i];
        const Style style{.stroke = kColors[i % std::size(kColors)], .strokeWidth = 1.6};
        for (size_t f = 1; f < c.values.size(); ++f)
            svg.line({xOf(f - 1), yOf(c.values[f - 1])}, {xOf(f), yOf(c.values[f])}, style);
        svg.line({kArea.right() + 20, y}, {kArea.right() + 45, y}, style);
        svg.text({kArea.right() + 52, y + 4}, fmt::format("{} {:.3f}", c.name, c.mean), Font{12});
        y += 20;
    }
    return svg.finish(kWidth, kHeight);
}

} // namespace mural::cli
