#include "nodes/head/planning/config/canvas_copies.hpp"

#include <algorithm>
#include <cmath>

#include "balancer/compound/partition.hpp"
#include "balancer/equalizers/make_equalizers.hpp"

namespace mural {
namespace {

bool isClose(double a, double b) { return std::abs(a - b) < 1e-6; }

bool isSame(const Viewport& a, const Viewport& b) {
    return isClose(a.x, b.x) && isClose(a.y, b.y) && isClose(a.w, b.w) && isClose(a.h, b.h);
}

// True if one scale and one offset move both copies.
bool moveAlike(const CanvasCopy& a, const CanvasCopy& b) {
    const Viewport whole{0, 0, 1, 1}; // of the source
    return a.source == b.source && a.target == b.target &&
           isSame(compose(a.to, relativeTo(whole, a.from)), compose(b.to, relativeTo(whole, b.from)));
}

// Returns the copy of the bounding box, or the copies themselves if they leave a gap in it.
std::vector<CanvasCopy> asBox(const std::vector<CanvasCopy>& copies) {
    CanvasCopy box = copies.front();
    double x1 = box.from.x + box.from.w, y1 = box.from.y + box.from.h, covered = 0;
    std::vector<compound::Rect> rects;
    for (const CanvasCopy& c : copies) {
        box.from.x = std::min(box.from.x, c.from.x);
        box.from.y = std::min(box.from.y, c.from.y);
        x1 = std::max(x1, c.from.x + c.from.w);
        y1 = std::max(y1, c.from.y + c.from.h);
        rects.push_back({static_cast<int>(rects.size()), c.from});
    }
    box.from.w = x1 - box.from.x;
    box.from.h = y1 - box.from.y;
    for (const compound::Cell& cell : compound::cellsOf(rects)) covered += cell.area.w * cell.area.h;
    if (!isClose(covered, box.from.w * box.from.h)) return copies;
    box.to = compose(copies.front().to, relativeTo(box.from, copies.front().from));
    return {box};
}

} // namespace

void placeMonitors(const config::ResolvedConfig& config, compound::FrameInput& input) {
    for (const auto& equalizer : balance::makeEqualizers(config, balance::Balance::Off))
        if (equalizer->effect() == balance::Effect::Inputs) equalizer->update({config, input}, input.compounds);
}

std::vector<CanvasCopy> joined(const std::vector<CanvasCopy>& copies) {
    std::vector<std::vector<CanvasCopy>> groups;
    for (const CanvasCopy& copy : copies) {
        const auto group = std::ranges::find_if(groups, [&](const auto& g) { return moveAlike(g.front(), copy); });
        std::vector<CanvasCopy>& into = group == groups.end() ? groups.emplace_back() : *group;
        if (std::ranges::none_of(into, [&](const CanvasCopy& c) { return isSame(c.from, copy.from); }))
            into.push_back(copy);
    }
    std::vector<CanvasCopy> all;
    for (const auto& group : groups) std::ranges::copy(asBox(group), std::back_inserter(all));
    return all;
}

} // namespace mural
