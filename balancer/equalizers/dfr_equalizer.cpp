#include "balancer/equalizers/dfr_equalizer.hpp"

#include <cmath>

#include "balancer/equalizers/split/split_equalizer.hpp"

namespace mural::balance {

namespace {

constexpr double kLeastPixels = 128; // shorter side of the area
constexpr double kNearRate = .02;    // deviation from the target rate that changes nothing

} // namespace

DfrEqualizer::DfrEqualizer(std::string id, const ResolvedConfig& config, Index compound,
                           const config::DfrEqualizer& fields)
    : Equalizer(std::move(id), "DFR_equalizer", compound, Effect::Zooms),
      root_(compound),
      full_(config.compounds[at(compound)].zoom),
      fullSides_(config.compounds.size(), 0) {
    parameters_.addNumber("framerate", fields.frameRate.value_or(10), .01, 1000, "Hz");
    parameters_.addNumber("damping", fields.damping.value_or(.5), 0, 1);
    parameters_.addNumber("minimum", fields.minimum.value_or(0), 0, 1);
    while (config.compounds[at(root_)].parent != kNone) root_ = config.compounds[at(root_)].parent;
    for (size_t c = 0; c < fullSides_.size(); ++c) {
        bool isHere = false;
        double area = 1;
        for (Index up = static_cast<Index>(c); up != kNone; up = config.compounds[at(up)].parent) {
            isHere = isHere || up == compound;
            area *= config.compounds[at(up)].zoom.x * config.compounds[at(up)].zoom.y;
        }
        if (isHere) fullSides_[c] = std::sqrt(area);
    }
}

void DfrEqualizer::observe(const FrameStatistics& statistics) {
    decision_.measured = statistics.frameNumber;
    double seconds = 0, own = 0; // own: the zoom of the measured frame, relative to the zoom of the file
    for (const RootStatistics& r : statistics.roots) {
        if (r.root != root_) continue;
        seconds = r.frameSeconds;
        isStill_ = r.isStill;
    }
    for (const LeafStatistics& leaf : statistics.leaves)
        if (const double full = fullSides_[at(leaf.compound)]; full > 0)
            own = std::max(own, std::sqrt(leaf.zoom.x * leaf.zoom.y) / full);
    if (isStill_ || !(seconds > 0) || !(own > 0)) return; // a still program draws no frames to measure
    rate_ = 1 / seconds;
    // The time is assumed to be in proportion to the pixels. The measured frame had its own zoom, so a decision
    // that is not measured yet does not count twice.
    wanted_ = own * std::sqrt(rate_ / parameters_.number("framerate"));
}

double DfrEqualizer::leastZoom(const FrameContext& context) const {
    const Index parent = context.config.compounds[at(compound())].parent;
    PixelViewport area = areaOf(context, parent == kNone ? compound() : parent);
    if (parent == kNone) { // its area is zoomed already
        const Index channel = context.config.compounds[at(compound())].destination;
        if (channel != kNone) area = context.input.sizes.channels[at(channel)];
    }
    const double side = std::min(area.w * full_.x, area.h * full_.y);
    return side > 0 ? std::clamp(kLeastPixels / side, parameters_.number("minimum"), 1.) : 1;
}

void DfrEqualizer::decide(const FrameContext& context, States& states) {
    CompoundState& state = states[at(compound())];
    const double target = parameters_.number("framerate"), least = leastZoom(context);
    double shown = 1;
    if (isStill_) {
        decision_.what = "full resolution: the program stands still";
    } else if (wanted_ > 0) {
        const double goal = std::clamp(wanted_, least, 1.);
        const bool isNear = std::abs(rate_ / target - 1) < kNearRate && std::abs(goal / zoom_ - 1) < kNearRate;
        // As in the Equalizer framework, a larger damping reacts faster.
        if (!isNear) zoom_ = std::clamp(zoom_ + parameters_.number("damping") * (goal - zoom_), least, 1.);
        decision_.what = goal == 1 && zoom_ > .99 ? "the rate permits full resolution"
                         : isNear                 ? "the rate is right"
                                                  : "zoom changed towards the rate";
        shown = zoom_;
    }
    decision_.inputs = {{"rate", rate_}, {"target", target}, {"zoom", shown}};
    const Zoom zoom{full_.x * shown, full_.y * shown};
    decision_.moved = state.zoom.value_or(full_) != zoom;
    if (decision_.moved || state.zoom) state.zoom = zoom;
}

} // namespace mural::balance
