#include "balancer/equalizers/view_equalizer.hpp"

#include <algorithm>
#include <cmath>

namespace mural::balance {

namespace {

constexpr double kLeastShare = .1;  // of a pipe; smaller shares are not worth a picture transfer
constexpr int kMostSegments = 2;    // that one pipe serves
constexpr double kNewestShare = .3; // of the newest frame
constexpr double kHysteresis = .15; // smaller changes of a need, in pipes, change nothing

} // namespace

ViewEqualizer::ViewEqualizer(std::string id, const ResolvedConfig& config, Index compound)
    : Equalizer(std::move(id), "view_equalizer", compound, Effect::Usage),
      usage_(config.compounds.size(), 0),
      before_(config.compounds.size(), 0) {
    free_.resize(config.pipes.size());
    served_.resize(config.pipes.size());
    for (const Index child : config.compounds[at(compound)].children) {
        Segment segment;
        const Index channel = config.compounds[at(child)].destination;
        if (channel != kNone) segment.ownPipe = config.windows[at(config.channels[at(channel)].window)].pipe;
        collect(config, child, segment);
        if (!segment.leaves.empty()) segments_.push_back(std::move(segment));
    }
}

void ViewEqualizer::collect(const ResolvedConfig& config, Index compound, Segment& segment) {
    const config::ResolvedCompound& c = config.compounds[at(compound)];
    if (c.isLeaf() && c.executing != kNone)
        segment.leaves.push_back({compound, config.windows[at(config.channels[at(c.executing)].window)].pipe});
    for (const Index child : c.children) collect(config, child, segment);
}

void ViewEqualizer::observe(const FrameStatistics& statistics) {
    for (Segment& s : segments_) {
        double seconds = 0, active = 0;
        for (const LeafStatistics& leaf : statistics.leaves) {
            const bool isHere = std::any_of(s.leaves.begin(), s.leaves.end(),
                                            [&](const Leaf& l) { return l.compound == leaf.compound; });
            if (!isHere) continue;
            seconds += leaf.loadSeconds();
            ++active;
        }
        if (active == 0) continue;
        // Each further pipe repeats some of the work, so the sum overstates the need.
        const double damped = seconds / std::sqrt(active);
        s.seconds = s.seconds > 0 ? (1 - kNewestShare) * s.seconds + kNewestShare * damped : damped;
        isMeasured_ = true;
        decision_.measured = statistics.frameNumber;
    }
}

template <class Permits> void ViewEqualizer::lend(Segment& segment, double& missing, Permits permits) {
    for (const Leaf& leaf : segment.leaves) {
        if (missing <= kLeastShare) return;
        const auto pipe = at(leaf.pipe);
        if (usage_[at(leaf.compound)] > 0 || free_[pipe] < kLeastShare || served_[pipe] >= kMostSegments ||
            !permits(leaf))
            continue;
        const double share = std::min(free_[pipe], missing);
        usage_[at(leaf.compound)] = share;
        free_[pipe] -= share;
        if (free_[pipe] < kLeastShare) free_[pipe] = 0;
        ++served_[pipe];
        missing -= share;
    }
}

void ViewEqualizer::assign(States& states) {
    std::swap(before_, usage_);
    std::fill(usage_.begin(), usage_.end(), 0);
    std::fill(free_.begin(), free_.end(), 1);
    std::fill(served_.begin(), served_.end(), 0);
    std::vector<double> missing;
    for (const Segment& s : segments_) missing.push_back(s.need);
    const auto pass = [&](auto permits) {
        for (size_t i = 0; i < segments_.size(); ++i)
            lend(segments_[i], missing[i], [&](const Leaf& leaf) { return permits(segments_[i], leaf); });
    };
    pass([](const Segment& s, const Leaf& leaf) { return leaf.pipe == s.ownPipe; });
    pass([&](const Segment&, const Leaf& leaf) { return before_[at(leaf.compound)] > 0; });
    pass([&](const Segment&, const Leaf& leaf) { return served_[at(leaf.pipe)] == 0; });
    pass([](const Segment&, const Leaf&) { return true; });
    for (Segment& s : segments_) {
        const bool isServed =
            std::any_of(s.leaves.begin(), s.leaves.end(), [&](const Leaf& l) { return usage_[at(l.compound)] > 0; });
        if (!isServed) { // each segment has at least one pipe, its own if it draws itself
            const auto own = std::ranges::find(s.leaves, s.ownPipe, &Leaf::pipe);
            usage_[at((own == s.leaves.end() ? s.leaves.front() : *own).compound)] = kLeastShare;
        }
        s.applied = s.need;
        for (const Leaf& leaf : s.leaves) {
            decision_.moved |= states[at(leaf.compound)].usage != usage_[at(leaf.compound)];
            states[at(leaf.compound)].usage = usage_[at(leaf.compound)];
        }
    }
    isAssigned_ = true;
}

void ViewEqualizer::decide(const FrameContext& context, States& states) {
    if (!isMeasured_ || segments_.size() < 2) return;
    double sum = 0;
    std::vector<bool> isUsed(context.config.pipes.size(), false);
    for (const Segment& s : segments_) {
        sum += s.seconds;
        for (const Leaf& leaf : s.leaves) isUsed[at(leaf.pipe)] = true;
    }
    const auto pipes = static_cast<double>(std::count(isUsed.begin(), isUsed.end(), true));
    bool isChanged = !isAssigned_;
    for (Segment& s : segments_) {
        s.need = sum > 0 ? s.seconds / sum * pipes : 1;
        isChanged |= std::abs(s.need - s.applied) > kHysteresis;
        decision_.inputs.emplace_back("need", s.need);
    }
    decision_.what = isChanged ? "pipes lent by need" : "needs are as before";
    if (isChanged) assign(states);
}

} // namespace mural::balance
