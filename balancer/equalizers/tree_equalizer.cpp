#include "balancer/equalizers/tree_equalizer.hpp"

namespace mural::balance {

TreeEqualizer::TreeEqualizer(std::string id, const ResolvedConfig& config, Index compound,
                             const config::TreeEqualizer& fields)
    : SplitEqualizer(std::move(id), "tree_equalizer", config, compound, fields.mode.value_or(SplitMode::TwoD)) {
    addCutParameters(fields.damping.value_or(.5), fields.boundary, fields.resistance);
}

double TreeEqualizer::timeOf(const SplitNode& node) const {
    double sum = 0;
    for (size_t i = node.first; i < node.first + node.count; ++i) sum += children_.loads()[i].seconds;
    return sum;
}

bool TreeEqualizer::split(const FrameContext&, const CutRules& rules) {
    divide(0, {}, rules, parameters_.number("damping"));
    double longest = 0, sum = 0;
    for (const ChildLoad& load : children_.loads()) {
        longest = std::max(longest, load.seconds);
        sum += load.seconds;
    }
    const double balance = sum / (static_cast<double>(rules.usersOf(tree_.nodes().front())) * longest);
    decision_.what = "cuts moved towards equal times";
    decision_.predictedGain = std::max(0., 1 - balance) * (1 - parameters_.number("damping"));
    decision_.inputs = {{"longest", longest}, {"sum", sum}, {"efficiency", balance}};
    return true;
}

void TreeEqualizer::divide(int index, const Part& part, const CutRules& rules, double damping) {
    SplitNode& node = tree_.nodes()[static_cast<size_t>(index)];
    if (node.isLeaf()) return;
    const double low = timeOf(tree_.low(node)), high = timeOf(tree_.high(node));
    const double lowUsage = rules.usageOf(tree_.low(node)), usage = lowUsage + rules.usageOf(tree_.high(node));
    double wanted = node.at;
    if (low + high > 0 && usage > 0) {
        const double target = (low + high) * lowUsage / usage;
        const double ideal = low >= target ? (low > 0 ? node.at * target / low : node.at)
                                           : node.at + (target - low) / high * (1 - node.at);
        wanted = (1 - damping) * ideal + damping * node.at;
    }
    if (damping < 1 || lowUsage == 0 || lowUsage == usage) tree_.moveCut(node, part, wanted, rules);
    const auto halves = cutPart(part, node.axis, node.at);
    divide(node.low, halves.first, rules, damping);
    divide(node.high, halves.second, rules, damping);
}

} // namespace mural::balance
