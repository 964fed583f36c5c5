#include "balancer/equalizers/split/split_equalizer.hpp"

#include <algorithm>

#include "balancer/compound/inheritance.hpp"

namespace mural::balance {

namespace {

compound::Inherited inheritedOf(const FrameContext& context, Index compound) {
    const Index parent = context.config.compounds[at(compound)].parent;
    if (parent == kNone) return compound::inherit(context.config, context.input, compound, nullptr);
    const compound::Inherited above = inheritedOf(context, parent);
    return compound::inherit(context.config, context.input, compound, &above);
}

void collectLeaves(const ResolvedConfig& config, Index compound, std::vector<Index>& leaves) {
    const config::ResolvedCompound& c = config.compounds[at(compound)];
    if (c.isLeaf()) leaves.push_back(compound);
    for (const Index child : c.children) collectLeaves(config, child, leaves);
}

} // namespace

PixelViewport areaOf(const FrameContext& context, Index compound) {
    const compound::Inherited own = inheritedOf(context, compound);
    return own.destination == kNone ? PixelViewport{0, 0, 0, 0} : own.area;
}

SplitEqualizer::SplitEqualizer(std::string id, const char* kind, const ResolvedConfig& config, Index compound,
                               SplitMode mode)
    : Equalizer(std::move(id), kind, compound, mode == SplitMode::Db ? Effect::Ranges : Effect::Viewports),
      children_(config, compound),
      mode_(mode),
      leaves_(children_.size()) {
    for (size_t i = 0; i < children_.size(); ++i) collectLeaves(config, children_.children()[i], leaves_[i]);
}

void SplitEqualizer::addCutParameters(double damping, const config::PixelsOrRange& boundary,
                                      const config::PixelsOrRange& resistance) {
    parameters_.addNumber("damping", damping, 0, 1);
    if (mode_ == SplitMode::Db) {
        parameters_.addNumber("boundary", boundary.range.value_or(std::numeric_limits<float>::epsilon()), 0, 1);
        parameters_.addNumber("resistance", resistance.range.value_or(0), 0, 1);
        return;
    }
    const config::Pixels2 grid = boundary.pixels.value_or(config::Pixels2{1, 1});
    const config::Pixels2 least = resistance.pixels.value_or(config::Pixels2{0, 0});
    parameters_.addPixels("boundary", {double(grid.x), double(grid.y)});
    parameters_.addPixels("resistance", {double(least.x), double(least.y)});
}

void SplitEqualizer::observe(const FrameStatistics& statistics) {
    if (!children_.read(statistics)) return;
    decision_.measured = statistics.frameNumber;
    hasMeasurement_ = isNew_ = true;
    learn(statistics);
}

CutRules SplitEqualizer::rules(const FrameContext& context, const States& states) const {
    CutRules rules;
    setUsage(states, rules.usage);
    if (mode_ == SplitMode::Db) {
        rules.boundaryRange = parameters_.number("boundary");
        rules.resistanceRange = parameters_.number("resistance");
        return rules;
    }
    const PixelStep boundary = parameters_.pixels("boundary"), resistance = parameters_.pixels("resistance");
    const double w = std::max(1, area_.w), h = std::max(1, area_.h);
    rules.boundaryX = boundary.x / w;
    rules.boundaryY = boundary.y / h;
    rules.resistanceX = resistance.x / w;
    rules.resistanceY = resistance.y / h;
    for (size_t i = 0; i < children_.size(); ++i) {
        const Index channel = children_.channel(i);
        if (channel == kNone) {
            rules.largest.push_back({});
            continue;
        }
        const PixelViewport& size = context.input.sizes.channels[at(channel)];
        rules.largest.push_back({0, 0, std::max(1, size.w) / w, std::max(1, size.h) / h});
    }
    return rules;
}

// A child of several leaves loses the share of its lost leaves.
void SplitEqualizer::setUsage(const States& states, std::vector<double>& usage) const {
    for (size_t i = 0; i < children_.size(); ++i) {
        const auto available =
            std::ranges::count_if(leaves_[i], [&](Index leaf) { return states[at(leaf)].isAvailable; });
        const double share = leaves_[i].empty() ? 1 : static_cast<double>(available) / double(leaves_[i].size());
        usage.push_back(share * std::max(0., states[at(children_.children()[i])].usage));
    }
}

void SplitEqualizer::decide(const FrameContext& context, States& states) {
    if (children_.size() < 2) {
        decision_.what = "nothing to divide";
        return;
    }
    const PixelViewport area = areaOf(context, compound());
    if (tree_.empty() || area.w != area_.w || area.h != area_.h) {
        const bool isFirst = tree_.empty();
        area_ = area;
        if (isFirst) tree_ = SplitTree(children_.size(), mode_, double(area.w) / std::max(1, area.h));
    }
    const CutRules now = rules(context, states);
    const bool isChanged = std::exchange(lastUsage_, now.usage) != now.usage ||
                           std::exchange(lastVersion_, parameters_.version()) != parameters_.version();
    if (!std::exchange(isNew_, false) && !isChanged) {
        if (hasMeasurement_) decision_.what = "no new measurements";
        return;
    }
    if (!hasMeasurement_ && !divideUnmeasured(now)) return;
    if (!hasMeasurement_ || split(context, now))
        decision_.moved = assignParts(children_.children(), mode_, tree_.parts(), states);
}

// Divides in proportion to the resources if any child has lost or regained its own. Returns false to keep the parts of
// the first frame.
bool SplitEqualizer::divideUnmeasured(const CutRules& rules) {
    const bool isWhole = std::ranges::all_of(rules.usage, [](double u) { return u == 1; });
    if (isWhole && !isReduced_) return false;
    isReduced_ = !isWhole;
    tree_.divideByUsage(rules);
    decision_.what = "cuts moved to other resources";
    return true;
}

} // namespace mural::balance
