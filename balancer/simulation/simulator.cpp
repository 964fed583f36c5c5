#include "balancer/simulation/simulator.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <set>

#include "balancer/compound/active_layouts.hpp"
#include "balancer/compound/even_split.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "balancer/planner/frame_planner.hpp"
#include "balancer/simulation/exact_map_equalizer.hpp"

namespace mural::simulation {

namespace {

using balance::Balance;
using balance::DensityGrid;
using balance::FrameStatistics;
using compound::RenderContext;
using config::at;
using config::Index;
using config::ResolvedConfig;

constexpr double kObjectSize = .05; // width of an object, as a fraction of the picture

balance::FramePlanner::Equalizers equalizersFor(Strategy strategy, const ResolvedConfig& config, const CostTrace& trace,
                                                const std::vector<double>& nodeSpeeds);

double speedOf(const ResolvedConfig& config, const std::vector<double>& speeds, Index channel) {
    if (speeds.empty()) return 1;
    const Index node = config.pipeOf(config.channels[at(channel)]).node;
    return speeds[at(node) % speeds.size()];
}

compound::FrameInput firstFrameOf(const ResolvedConfig& config, const Conditions& conditions) {
    compound::FrameInput input = compound::firstFrame(config);
    input.activeLayouts.resize(config.canvases.size(), 0);
    for (const std::string& layout : conditions.layouts) compound::activateLayout(config, layout, input);
    return input;
}

// Returns the contexts that draw in any frame, with the parts of the file.
std::vector<RenderContext> drawsOf(const ResolvedConfig& config, compound::FrameInput input) {
    constexpr uint64_t kFrames = 64; // more than any period in use
    std::vector<RenderContext> draws;
    for (input.frameNumber = 0; input.frameNumber < kFrames; ++input.frameNumber) {
        const bool isPeriodic = std::ranges::any_of(config.compounds, [](const auto& c) { return c.period > 1u; });
        if (input.frameNumber > 0 && !isPeriodic) break;
        const compound::FramePlan plan = compound::planFrame(config, input);
        for (const compound::ChannelPlan& channel : plan.channels)
            for (const compound::PlannedTask& task : channel.tasks)
                if (task.kind == config::Task::Draw) draws.push_back(plan.contexts[at(task.context)]);
    }
    return draws;
}

class Simulator {
public:
    Simulator(const ResolvedConfig& config, const CostTrace& trace, const Conditions& conditions, Strategy strategy)
        : trace_(trace),
          conditions_(conditions),
          random_(conditions.seed),
          noise_(0, std::max(conditions.noise, 1e-12)),
          planner_(config, firstFrameOf(config, conditions), equalizersFor(strategy, config, trace, conditions.speeds)),
          cells_(trace.columns, trace.rows),
          ranges_(trace.ranges, 1),
          times_(config.windows.size(), 0) {
        std::set<Index> compounds, windows;
        for (const RenderContext& c : drawsOf(config, planner_.input())) {
            compounds.insert(c.compound);
            windows.insert(windowOf(c.channel));
        }
        outcome_.leaves = compounds.size();
        windows_ = windows.size();
    }

    Outcome run() {
        for (size_t frame = 0; frame < conditions_.frames; ++frame) {
            planner_.next();
            setCosts(frame);
            pending_.push_back(draw(frame));
            if (pending_.size() < static_cast<size_t>(conditions_.latency)) continue;
            planner_.addStatistics(pending_.front());
            pending_.pop_front();
        }
        for (const auto& leaf : last_.leaves) outcome_.parts.push_back(leaf.viewport);
        return std::move(outcome_);
    }

private:
    [[nodiscard]] Index windowOf(Index channel) const { return planner_.config().channels[at(channel)].window; }

    void setCosts(size_t frame) {
        const size_t now = frame % trace_.frames.size(),
                     before = (frame + trace_.frames.size() - 1) % trace_.frames.size();
        const CostFrame &costs = trace_.frames[now], &old = trace_.frames[before];
        if (frame > 0 && costs.cells == old.cells && costs.ranges == old.ranges) return;
        cells_.setCells(costs.cells);
        ranges_.setCells(costs.ranges);
    }

    // Objects cost each node that they touch, so their part of the cost is that of a wider part of the picture.
    [[nodiscard]] double costOf(const Viewport& part, const Range& range) const {
        double cost = cells_.of(part);
        if (conditions_.overlap > 0) {
            const double half = kObjectSize / 2;
            const Viewport dilated{part.x - half, part.y - half, part.w + kObjectSize, part.h + kObjectSize};
            const Viewport wide = intersect(dilated, Viewport{});
            cost = (1 - conditions_.overlap) * cost + conditions_.overlap * cells_.of(wide);
        }
        const Viewport slice{range.start, 0, range.end - range.start, 1};
        return ranges_.total() > 0 ? cost * ranges_.of(slice) / ranges_.total() : 0;
    }

    FrameStatistics draw(size_t frame) {
        FrameStatistics statistics;
        statistics.frameNumber = frame;
        const ResolvedConfig& config = planner_.config();
        const compound::FramePlan& plan = planner_.plan();
        std::fill(times_.begin(), times_.end(), 0);
        std::vector<bool> isHelping(config.channels.size(), false);
        for (const compound::ChannelPlan& channel : plan.channels)
            for (const compound::PlannedTask& task : channel.tasks) {
                if (task.kind != config::Task::Draw) continue;
                const RenderContext& c = plan.contexts[at(task.context)];
                balance::LeafStatistics leaf = balance::leafOf(c, planner_.input().sizes);
                const double seconds = costOf(c.view == config::kNone ? leaf.viewport : c.part, leaf.range) * c.zoom.x *
                                       c.zoom.y / speedOf(config, conditions_.speeds, c.channel);
                times_[at(windowOf(c.channel))] += seconds;
                leaf.busySeconds = seconds * std::max(.2, 1 + (conditions_.noise > 0 ? noise_(random_) : 0));
                leaf.end = leaf.busySeconds;
                statistics.leaves.push_back(leaf);
                if (c.channel == c.destination || isHelping[at(c.channel)]) continue;
                isHelping[at(c.channel)] = true;
                if (conditions_.assembly > 0) statistics.assemblies.push_back({c.destination, conditions_.assembly});
            }
        for (const auto& assembly : statistics.assemblies) times_[at(windowOf(assembly.channel))] += assembly.seconds;
        rate();
        outcome_.travel.push_back(frame == 0 ? 0 : travelTo(statistics));
        last_ = statistics;
        return statistics;
    }

    void rate() {
        double longest = 0, sum = 0;
        for (const double t : times_) {
            longest = std::max(longest, t);
            sum += t;
        }
        outcome_.longest.push_back(longest);
        outcome_.efficiency.push_back(longest > 0 ? sum / (static_cast<double>(windows_) * longest) : 1);
    }

    // Leaves without work have left, or not yet entered, the lists; their edges do not count.
    [[nodiscard]] double travelTo(const FrameStatistics& now) const {
        double moved = 0;
        size_t j = 0;
        for (const auto& leaf : now.leaves) {
            while (j < last_.leaves.size() && last_.leaves[j].compound != leaf.compound) ++j;
            if (j == last_.leaves.size()) return moved;
            const auto& old = last_.leaves[j];
            const Viewport &a = leaf.viewport, &b = old.viewport;
            moved += std::abs(a.x - b.x) + std::abs((a.x + a.w) - (b.x + b.w)) + std::abs(a.y - b.y) +
                     std::abs((a.y + a.h) - (b.y + b.h)) + std::abs(leaf.range.start - old.range.start) +
                     std::abs(leaf.range.end - old.range.end);
        }
        return moved;
    }

    const CostTrace& trace_;
    const Conditions conditions_;
    std::mt19937 random_;
    std::normal_distribution<> noise_;
    balance::FramePlanner planner_;
    DensityGrid cells_, ranges_;
    std::vector<double> times_; // per window
    size_t windows_ = 0;        // windows that may draw
    std::deque<FrameStatistics> pending_;
    FrameStatistics last_;
    Outcome outcome_;
};

std::optional<config::SplitMode> splitModeOf(const config::ResolvedCompound& c) {
    for (const config::Equalizer& e : c.equalizers) {
        if (const auto* load = std::get_if<config::LoadEqualizer>(&e))
            return load->mode.value_or(config::SplitMode::TwoD);
        if (const auto* tree = std::get_if<config::TreeEqualizer>(&e))
            return tree->mode.value_or(config::SplitMode::TwoD);
    }
    return {};
}

balance::FramePlanner::Equalizers exactMaps(const ResolvedConfig& config, const CostTrace& trace,
                                            const std::vector<double>& nodeSpeeds) {
    balance::FramePlanner::Equalizers all;
    for (size_t i = 0; i < config.compounds.size(); ++i) {
        const auto mode = splitModeOf(config.compounds[i]);
        if (!mode) continue;
        std::vector<double> speeds;
        for (const Index child : config.compounds[i].children)
            speeds.push_back(speedOf(config, nodeSpeeds, config.compounds[at(child)].executing));
        all.push_back(std::make_unique<ExactMapEqualizer>(std::to_string(i) + ".exact_map", config,
                                                          static_cast<Index>(i), *mode, trace, std::move(speeds)));
    }
    return all;
}

balance::FramePlanner::Equalizers equalizersFor(Strategy strategy, const ResolvedConfig& config, const CostTrace& trace,
                                                const std::vector<double>& nodeSpeeds) {
    switch (strategy) {
    case Strategy::Even: return balance::makeEqualizers(config, Balance::Off);
    case Strategy::Load: return balance::makeEqualizers(config, Balance::Load);
    case Strategy::Tree: return balance::makeEqualizers(config, Balance::Tree);
    case Strategy::CostMap: return balance::makeEqualizers(config, Balance::Auto);
    case Strategy::AsInFile: return balance::makeEqualizers(config, Balance::AsInFile);
    case Strategy::ExactMap: return exactMaps(config, trace, nodeSpeeds);
    case Strategy::LoadUndamped: break;
    }
    auto all = balance::makeEqualizers(config, Balance::Load);
    for (const auto& e : all)
        if (e->parameters().find("damping") != nullptr) (void)e->set("damping", "0");
    return all;
}

} // namespace

const char* nameOf(Strategy strategy) {
    switch (strategy) {
    case Strategy::Even: return "even";
    case Strategy::Load: return "load";
    case Strategy::LoadUndamped: return "load-undamped";
    case Strategy::Tree: return "tree";
    case Strategy::CostMap: return "costmap";
    case Strategy::ExactMap: return "exact";
    case Strategy::AsInFile: break;
    }
    return "file";
}

std::string problemOf(const ResolvedConfig& config, const CostTrace& trace, const Conditions& conditions) {
    if (trace.frames.empty()) return "the trace has no frames";
    if (conditions.latency < 1) return "the latency must be 1 or more";
    compound::FrameInput input = compound::firstFrame(config);
    for (const std::string& layout : conditions.layouts)
        if (!compound::activateLayout(config, layout, input))
            return "no canvas has a layout " + layout + "; mural config print shows the layouts";
    return drawsOf(config, firstFrameOf(config, conditions)).empty() ? "no compound draws in this layout" : "";
}

Outcome simulate(const ResolvedConfig& config, const CostTrace& trace, const Conditions& conditions,
                 Strategy strategy) {
    return Simulator(config, trace, conditions, strategy).run();
}

} // namespace mural::simulation
