// A configuration whose only compound divides a picture or a range, and checks of its parts.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "balancer/compound/even_split.hpp"
#include "balancer/planner/frame_planner.hpp"
#include "balancer/simulation/simulator.hpp"

namespace mural::balance::testing {

using config::SplitMode;

// Returns the problem of parts that must be inside, disjoint, and cover the whole; empty: none.
inline std::string problemOfParts(const std::vector<Index>& children, SplitMode mode, const States& states) {
    double covered = 0;
    std::vector<Viewport> areas;
    for (const Index child : children) {
        const CompoundState& s = states[at(child)];
        const Range r = s.range.value_or(Range{});
        const Viewport v =
            mode == SplitMode::Db ? Viewport{r.start, 0, r.end - r.start, 1} : s.viewport.value_or(Viewport{});
        if (v.empty()) {
            if (s.active) return "an active child without a part";
            continue;
        }
        if (!s.active) return "an inactive child with a part";
        if (v.x < -1e-9 || v.y < -1e-9 || v.x + v.w > 1 + 1e-9 || v.y + v.h > 1 + 1e-9) return "a part outside";
        for (const Viewport& other : areas)
            if (!intersect(v, other).empty()) return "two parts overlap";
        areas.push_back(v);
        covered += v.w * v.h;
    }
    return std::abs(covered - 1) < 1e-6 ? "" : "parts cover " + std::to_string(covered);
}

class DividedPicture {
public:
    using Cost = std::function<double(const LeafStatistics&)>;

    DividedPicture(size_t children, SplitMode mode)
        : loaded_(simulation::dividedConfig(children, mode)), input_(compound::firstFrame(loaded_.resolved)) {}

    [[nodiscard]] const ResolvedConfig& config() const { return loaded_.resolved; }
    [[nodiscard]] Index root() const { return config().roots.front(); }
    [[nodiscard]] const std::vector<Index>& children() const { return config().compounds[at(root())].children; }
    [[nodiscard]] States& states() { return input_.compounds; }
    [[nodiscard]] const compound::FrameInput& input() const { return input_; }

    // Returns the statistics of a frame with the current parts.
    FrameStatistics draw(const Cost& cost) {
        FrameStatistics statistics;
        statistics.frameNumber = input_.frameNumber;
        for (const Index child : children()) {
            const CompoundState& s = states()[at(child)];
            if (!s.active) continue;
            LeafStatistics leaf;
            leaf.compound = child;
            leaf.viewport = s.viewport.value_or(Viewport{});
            leaf.range = s.range.value_or(Range{});
            if (leaf.viewport.empty() || leaf.range.empty()) continue;
            leaf.busySeconds = cost(leaf);
            statistics.leaves.push_back(leaf);
        }
        return statistics;
    }
    void update(Equalizer& equalizer) {
        const FrameContext context{config(), input_};
        equalizer.update(context, input_.compounds);
        ++input_.frameNumber;
    }
    // Lets the equalizer see `frames` frames, each known before the next.
    void run(Equalizer& equalizer, const Cost& cost, int frames) {
        for (int f = 0; f < frames; ++f) {
            update(equalizer);
            equalizer.observe(draw(cost));
        }
        update(equalizer);
    }

private:
    compound::LoadedConfig loaded_;
    compound::FrameInput input_;
};

// Cost of a part whose density is 1 on the left and `ratio` on the right of x = .75, or of the range's .75.
inline double rightHeavy(const LeafStatistics& leaf, double ratio) {
    const auto along = [&](double from, double to) {
        const double left = std::max(0., std::min(to, .75) - from);
        return left + ratio * (to - from - left);
    };
    if (!leaf.range.full()) return along(leaf.range.start, leaf.range.end);
    return leaf.viewport.h * along(leaf.viewport.x, leaf.viewport.x + leaf.viewport.w);
}

inline double balanceOf(const FrameStatistics& statistics, size_t children) {
    double sum = 0, longest = 0;
    for (const LeafStatistics& leaf : statistics.leaves) {
        sum += leaf.busySeconds;
        longest = std::max(longest, leaf.busySeconds);
    }
    return sum / (static_cast<double>(children) * longest);
}

} // namespace mural::balance::testing
