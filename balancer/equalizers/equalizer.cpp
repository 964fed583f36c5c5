#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

LeafStatistics leafOf(const compound::RenderContext& c, const compound::DisplaySizes& sizes) {
    const PixelViewport& channel = sizes.channels[at(c.destination)];
    const double w = std::max(1, channel.w + c.overdraw.left + c.overdraw.right);
    const double h = std::max(1, channel.h + c.overdraw.bottom + c.overdraw.top);
    LeafStatistics leaf;
    leaf.compound = c.compound;
    leaf.viewport = {c.x.first() / w, c.y.first() / h, (c.x.last(c.area.w) - c.x.first()) / w,
                     (c.y.last(c.area.h) - c.y.first()) / h};
    leaf.range = c.range;
    leaf.zoom = c.zoom;
    return leaf;
}

bool Equalizer::isAvailabilityChanged(const States& states) {
    std::vector<bool> now(states.size());
    for (size_t i = 0; i < states.size(); ++i) now[i] = states[i].isAvailable;
    return std::exchange(frozenAvailability_, now) != now;
}

void Equalizer::freeze(bool frozen, const States& states) {
    isFrozen_ = frozen;
    if (frozen) (void)isAvailabilityChanged(states);
}

void Equalizer::update(const FrameContext& context, States& states) {
    decision_.frame = context.input.frameNumber;
    decision_.moved = false;
    decision_.predictedGain = 0;
    decision_.inputs.clear();
    const bool dividesAnew = isFrozen_ && isAvailabilityChanged(states) && effect_ != Effect::Zooms;
    if (isFrozen_ && !dividesAnew) {
        decision_.what = "frozen";
        return;
    }
    decide(context, states);
}

} // namespace mural::balance
