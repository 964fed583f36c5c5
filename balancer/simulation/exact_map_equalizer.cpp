#include "balancer/simulation/exact_map_equalizer.hpp"

namespace mural::simulation {

using balance::Axis;

ExactMapEqualizer::ExactMapEqualizer(std::string id, const config::ResolvedConfig& config, config::Index compound,
                                     config::SplitMode mode, const CostTrace& trace, std::vector<double> speeds)
    : SplitEqualizer(std::move(id), "exact_map", config, compound, mode),
      trace_(trace),
      speeds_(std::move(speeds)),
      map_(mode == config::SplitMode::Db ? trace.ranges : trace.columns,
           mode == config::SplitMode::Db ? 1 : trace.rows) {
    addCutParameters(0, {}, {});
}

void ExactMapEqualizer::setUsage(const balance::States& states, std::vector<double>& usage) const {
    SplitEqualizer::setUsage(states, usage);
    for (size_t i = 0; i < usage.size(); ++i) usage[i] *= speeds_[i];
}

bool ExactMapEqualizer::split(const balance::FrameContext&, const balance::CutRules& rules) {
    const CostFrame& frame = trace_.frames[decision_.measured % trace_.frames.size()];
    map_.setCells(mode() == config::SplitMode::Db ? frame.ranges : frame.cells);
    cut(0, {}, rules);
    decision_.what = "cuts moved to equal costs of the exact map";
    return true;
}

void ExactMapEqualizer::cut(int index, const balance::Part& part, const balance::CutRules& rules) {
    balance::SplitNode& node = tree_.nodes()[static_cast<size_t>(index)];
    if (node.isLeaf()) return;
    if (mode() == config::SplitMode::TwoD)
        node.axis = part.viewport.w * area_.w >= part.viewport.h * area_.h ? Axis::X : Axis::Y;
    const double share = rules.usageOf(tree_.low(node)) / rules.usageOf(node);
    tree_.moveCut(node, part, map_.cutOf(part, node.axis, share), rules);
    const auto halves = balance::cutPart(part, node.axis, node.at);
    cut(node.low, halves.first, rules);
    cut(node.high, halves.second, rules);
}

} // namespace mural::simulation
