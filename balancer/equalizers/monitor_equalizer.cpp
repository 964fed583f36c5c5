#include "balancer/equalizers/monitor_equalizer.hpp"

#include <cmath>

#include "balancer/compound/frusta.hpp"
#include "balancer/equalizers/split/split_equalizer.hpp"

namespace mural::balance {

namespace {

Index producerOf(const ResolvedConfig& config, Index compound, const std::string& frame) {
    const config::ResolvedCompound& c = config.compounds[at(compound)];
    for (const config::ResolvedFrame& f : c.outputFrames)
        if (f.name == frame) return compound;
    for (const Index child : c.children)
        if (const Index found = producerOf(config, child, frame); found != kNone) return found;
    return kNone;
}

} // namespace

MonitorEqualizer::MonitorEqualizer(std::string id, const ResolvedConfig& config, Index compound)
    : Equalizer(std::move(id), "monitor_equalizer", compound, Effect::Inputs) {
    Index root = compound;
    while (config.compounds[at(root)].parent != kNone) root = config.compounds[at(root)].parent;
    const config::ResolvedCompound& own = config.compounds[at(compound)];
    for (const config::ResolvedFrame& f : own.inputFrames) {
        const Index producer = producerOf(config, root, f.name);
        const Index channel = producer == kNone ? kNone : config.compounds[at(producer)].destination;
        const bool isShown =
            channel != kNone && channel != own.destination && config.channels[at(channel)].view != kNone;
        sources_.push_back(isShown ? channel : kNone);
    }
}

void MonitorEqualizer::decide(const FrameContext& context, States& states) {
    CompoundState& state = states[at(compound())];
    const PixelViewport area = areaOf(context, compound());
    std::vector<std::optional<compound::InputPlacement>> places(sources_.size());
    double count = 0;
    for (size_t i = 0; i < sources_.size() && !area.empty(); ++i) {
        if (sources_[i] == kNone) continue;
        const config::ResolvedChannel& channel = context.config.channels[at(sources_[i])];
        const PixelViewport& size = context.input.sizes.channels[at(sources_[i])];
        const PixelViewport shown = apply(area, compound::coverage(context.config, channel));
        if (size.empty() || shown.empty()) continue;
        places[i] = compound::InputPlacement{
            shown.x - area.x, shown.y - area.y, {shown.w / double(size.w), shown.h / double(size.h)}};
        ++count;
    }
    const auto isSame = [](const auto& a, const auto& b) {
        return a.has_value() == b.has_value() && (!a || (a->x == b->x && a->y == b->y && a->zoom == b->zoom));
    };
    decision_.what = "pictures placed by their parts of the view";
    decision_.inputs = {{"pictures", count}};
    decision_.moved = !std::equal(places.begin(), places.end(), state.inputs.begin(), state.inputs.end(), isSame);
    state.inputs = std::move(places);
}

} // namespace mural::balance
