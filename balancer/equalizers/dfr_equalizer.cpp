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
      isHere_(config.compounds.size(), false) {
    parameters_.addNumber("framerate", fields.frameRate.value_or(10), .01, 1000, "Hz");
    parameters_.addNumber("damping", fields.damping.value_or(.5), 0, 1);
    while (config.compounds[at(root_)].parent != kNone) root_ = config.compounds[at(root_)].parent;
    for (size_t c = 0; c < isHere_.size(); ++c) {
        Index up = static_cast<Index>(c);
        while (up != kNone && up != compound) up = config.compounds[at(up)].parent;
        isHere_[c] = up == compound;
    }
}

void DfrEqualizer::observe(const FrameStatistics& statistics) {
    decision_.measured = statistics.frameNumber;
    double seconds = 0, drawn = 0;
    for (const RootStatistics& r : statistics.roots) {
        if (r.root != root_) continue;
        seconds = r.frameSeconds;
        isStill_ = r.isStill;
    }
    for (const LeafStatistics& leaf : statistics.leaves)
        if (isHere_[at(leaf.compound)]) drawn = std::max(drawn, std::sqrt(leaf.zoom.x * leaf.zoom.y));
    if (isStill_ || !(seconds > 0) || !(drawn > 0)) return; // a still program draws no frames to measure
    rate_ = 1 / seconds;
    // The time is assumed to be in proportion to the pixels. The measured frame had its own zoom, so a decision
    // that is not measured yet does not count twice.
    const double own = drawn / std::max(1e-9, std::sqrt(full_.x * full_.y));
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
    return side > 0 ? std::min(1., kLeastPixels / side) : 1;
}

// The area must fit into the channel that draws it.
double DfrEqualizer::mostZoom(const FrameContext& context) const {
    const config::ResolvedCompound& c = context.config.compounds[at(compound())];
    if (c.executing == kNone || c.destination == kNone) return 1;
    const PixelViewport& source = context.input.sizes.channels[at(c.executing)];
    const PixelViewport& destination = context.input.sizes.channels[at(c.destination)];
    const double most =
        std::min(source.w / std::max(1., destination.w * full_.x), source.h / std::max(1., destination.h * full_.y));
    return std::clamp(most, .01, kMaxZoom);
}

void DfrEqualizer::decide(const FrameContext& context, States& states) {
    CompoundState& state = states[at(compound())];
    const double target = parameters_.number("framerate"), least = leastZoom(context);
    const double most = std::max(least, mostZoom(context));
    double shown = std::min(1., most);
    if (isStill_) {
        decision_.what = "full resolution: the program stands still";
        shown = std::max(shown, std::min(zoom_, most));
    } else if (wanted_ > 0) {
        const double goal = std::clamp(wanted_, least, most);
        const bool isNear = std::abs(rate_ / target - 1) < kNearRate && std::abs(goal / zoom_ - 1) < kNearRate;
        // As in the Equalizer framework, a larger damping reacts faster.
        if (!isNear) zoom_ = std::clamp(zoom_ + parameters_.number("damping") * (goal - zoom_), least, most);
        decision_.what = isNear ? "the rate is right" : "zoom changed towards the rate";
        shown = zoom_;
    }
    decision_.inputs = {{"rate", rate_}, {"target", target}, {"zoom", shown}};
    const Zoom zoom{full_.x * shown, full_.y * shown};
    decision_.moved = state.zoom.value_or(full_) != zoom;
    if (decision_.moved || state.zoom) state.zoom = zoom;
}

} // namespace mural::balance
