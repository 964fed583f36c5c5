#include "nodes/head/planning/config/follow_frames.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "balancer/compound/partition.hpp"

namespace mural {
namespace {

using compound::RenderContext;
using config::Index;

// A draw whose picture reaches one part of the wall, or several parts with the same scale and offset.
struct Arrival {
    const ConfigDraw* draw;
    Zoom scale;  // from the drawn picture to the part of the wall
    double x, y; // position of the drawn picture's corner, in units of the picture's size
    Zoom transferScale;
    [[nodiscard]] bool moved() const {
        return std::abs(scale.x - 1) > 1e-6 || std::abs(scale.y - 1) > 1e-6 || std::abs(x) > 1e-6 || std::abs(y) > 1e-6;
    }
};

bool alike(const Arrival& a, const Arrival& b) {
    const auto isClose = [](double v, double w) { return std::abs(v - w) < 1e-6; };
    return isClose(a.scale.x, b.scale.x) && isClose(a.scale.y, b.scale.y) && isClose(a.x, b.x) && isClose(a.y, b.y) &&
           isClose(a.transferScale.x, b.transferScale.x) && isClose(a.transferScale.y, b.transferScale.y);
}

// True if the pictures that meet in a cell of the wall have one scale and one offset, or none has any.
bool canShareCell(const std::vector<const Arrival*>& there) {
    const Arrival& first = *there.front();
    return std::ranges::all_of(
               there, [&](const Arrival* a) { return alike(*a, first) && a->draw->area == first.draw->area; }) ||
           std::ranges::none_of(there, [](const Arrival* a) { return a->moved() || !a->transferScale.none(); });
}

// Returns the draw of a picture's part that the wall shows in `cell`.
ConfigDraw cellPart(const Arrival& a, const Viewport& cell, bool keepsPlace) {
    ConfigDraw part = *a.draw;
    part.area = cell;
    if (!keepsPlace) return part;
    part.transferScale = a.transferScale;
    if (!a.moved()) return part;
    const Viewport own = relativeTo(cell, a.draw->area);
    part.area = compose(a.draw->area, Viewport{(own.x - a.x) / a.scale.x, (own.y - a.y) / a.scale.y, own.w / a.scale.x,
                                               own.h / a.scale.y});
    part.shown = cell;
    return part;
}

class FrameFollower {
public:
    FrameFollower(const ConfigSource& source, SessionPlan& plan) : source_(source), plan_(plan) {}

    // Divides the draws of one picture of a destination.
    void takeApart(std::vector<const ConfigDraw*> draws, std::vector<ConfigDraw>& into) {
        // the destination's own picture comes first
        std::stable_partition(draws.begin(), draws.end(),
                              [](const ConfigDraw* d) { return d->context.channel == d->context.destination; });
        arrivals_.clear();
        for (const compound::Cell& cell : compound::cellsOf(neededOf(arrive(draws)))) {
            std::vector<const Arrival*> there;
            for (const int i : cell.of) there.push_back(&arrivals_[static_cast<size_t>(i)]);
            const bool together = canShareCell(there);
            if (!together) warnUnequal(there.front()->draw->context);
            for (const Arrival* a : there) into.push_back(cellPart(*a, cell.area, together));
        }
    }

private:
    // Fills arrivals_. Returns the parts of the wall that each of them reaches.
    std::vector<compound::Rect> arrive(const std::vector<const ConfigDraw*>& draws) {
        std::vector<compound::Rect> pieces;
        for (const ConfigDraw* d : draws) {
            if (d->flow.parts.empty())
                plan_.explain.push_back(source_.placeOf(d->context.compound) +
                                        ": the pixels drawn here are not transferred to the wall");
            for (const compound::ShownPart& p : d->flow.parts) {
                const Zoom scale{p.to.w / p.from.w, p.to.h / p.from.h};
                const Arrival a{d, scale, p.to.x - p.from.x * scale.x, p.to.y - p.from.y * scale.y, p.transferScale};
                auto known = std::find_if(arrivals_.begin(), arrivals_.end(),
                                          [&](const Arrival& other) { return other.draw == d && alike(other, a); });
                if (known == arrivals_.end()) known = arrivals_.insert(arrivals_.end(), a);
                pieces.push_back({static_cast<int>(known - arrivals_.begin()), compose(d->area, p.to)});
            }
        }
        return pieces;
    }

    // Of two draws with the same range the first one counts, because a depth test keeps existing pixels.
    [[nodiscard]] std::vector<compound::Rect> neededOf(const std::vector<compound::Rect>& pieces) const {
        std::vector<compound::Rect> needed;
        for (const compound::Cell& cell : compound::cellsOf(pieces)) {
            std::vector<Range> drawn;
            for (const int i : cell.of) {
                const Range& range = arrivals_[static_cast<size_t>(i)].draw->context.range;
                if (std::find(drawn.begin(), drawn.end(), range) != drawn.end()) continue;
                drawn.push_back(range);
                needed.push_back({i, cell.area});
            }
        }
        return needed;
    }

    void warnUnequal(const RenderContext& c) {
        if (!reported_.insert(c.destination).second) return;
        plan_.warnings.push_back(source_.placeOf(c.compound) +
                                 ": ranges of one picture are composited by depth at their drawn size; the zoom of "
                                 "their frames must be equal and is ignored");
    }

    const ConfigSource& source_;
    SessionPlan& plan_;
    std::vector<Arrival> arrivals_; // of the picture in progress
    std::set<Index> reported_;      // destinations already reported for unequal pictures
};

} // namespace

void followFrames(const ConfigSource& source, std::vector<ConfigDraw>& draws, SessionPlan& plan) {
    using Destination = std::tuple<Index, Eye>;
    using PictureKey = std::tuple<Index, Eye, int, int, int, int, int, int, uint32_t>; // of a destination
    std::set<Destination> steered;
    for (const ConfigDraw& d : draws)
        if (d.flow.steered) steered.insert({d.context.destination, d.context.eye});
    if (steered.empty()) return;
    std::vector<ConfigDraw> followed;
    std::map<PictureKey, std::vector<const ConfigDraw*>> pictures;
    for (const ConfigDraw& d : draws) {
        const RenderContext& c = d.context;
        if (!steered.contains({c.destination, c.eye}))
            followed.push_back(d);
        else
            pictures[{c.destination, c.eye, c.pixel.x, c.pixel.y, c.pixel.w, c.pixel.h, c.subPixel.index,
                      c.subPixel.size, c.phase}]
                .push_back(&d);
    }
    FrameFollower follower(source, plan);
    for (const auto& [key, parts] : pictures) follower.takeApart(parts, followed);
    draws = std::move(followed);
}

} // namespace mural
