#include "balancer/compound/even_split.hpp"

#include <span>

#include "balancer/compound/inheritance.hpp"

namespace mural::compound {

namespace {

using config::SplitMode;

// Bisects the children and the area until each child has its own part. Cuts the longer side first.
void divide(std::span<const Index> children, SplitMode mode, const Viewport& part, const Range& range, PixelSize whole,
            FrameInput& input) {
    if (children.size() == 1) {
        CompoundState& state = input.compounds[at(children.front())];
        if (mode == SplitMode::Db)
            state.range = range;
        else
            state.viewport = part;
        return;
    }
    const size_t half = children.size() / 2;
    const double share = static_cast<double>(half) / static_cast<double>(children.size());
    Viewport first = part, second = part;
    Range low = range, high = range;
    if (mode == SplitMode::Db) {
        low.end = high.start = range.start + (range.end - range.start) * share;
    } else if (mode == SplitMode::Vertical || (mode == SplitMode::TwoD && part.w * whole.w >= part.h * whole.h)) {
        first.w = part.w * share;
        second.x = part.x + first.w;
        second.w = part.w - first.w;
    } else {
        first.h = part.h * share;
        second.y = part.y + first.h;
        second.h = part.h - first.h;
    }
    divide(children.first(half), mode, first, low, whole, input);
    divide(children.subspan(half), mode, second, high, whole, input);
}

void visit(const ResolvedConfig& config, Index compound, const Inherited* above, FrameInput& input) {
    const config::ResolvedCompound& c = config.compounds[at(compound)];
    const Inherited own = inherit(config, input, compound, above);
    for (const config::Equalizer& e : c.equalizers) {
        std::optional<SplitMode> mode;
        if (const auto* load = std::get_if<config::LoadEqualizer>(&e)) mode = load->mode.value_or(SplitMode::TwoD);
        if (const auto* tree = std::get_if<config::TreeEqualizer>(&e)) mode = tree->mode.value_or(SplitMode::TwoD);
        if (mode && !c.children.empty()) divide(c.children, *mode, {}, {}, {own.area.w, own.area.h}, input);
    }
    for (const Index child : c.children) visit(config, child, &own, input);
}

} // namespace

void splitEvenly(const ResolvedConfig& config, FrameInput& input) {
    input.compounds.resize(config.compounds.size());
    for (const Index root : config.roots) visit(config, root, nullptr, input);
}

FrameInput firstFrame(const ResolvedConfig& config) {
    FrameInput input;
    input.sizes = displaySizes(config);
    splitEvenly(config, input);
    return input;
}

} // namespace mural::compound
