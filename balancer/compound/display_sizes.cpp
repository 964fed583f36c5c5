#include "balancer/compound/display_sizes.hpp"

namespace mural::compound {

namespace {

PixelViewport within(const PixelViewport& whole, const Viewport& part) {
    if (!config::inPixels(part)) return apply(whole, part);
    return {whole.x + static_cast<int32_t>(part.x), whole.y + static_cast<int32_t>(part.y),
            static_cast<int32_t>(part.w), static_cast<int32_t>(part.h)};
}

void sizeChannels(const ResolvedConfig& config, Index window, DisplaySizes& sizes) {
    const PixelViewport& w = sizes.windows[ResolvedConfig::at(window)];
    for (const Index c : config.windows[ResolvedConfig::at(window)].channels) {
        sizes.channels[ResolvedConfig::at(c)] =
            within({0, 0, w.w, w.h}, config.channels[ResolvedConfig::at(c)].viewport);
    }
}

} // namespace

DisplaySizes displaySizes(const ResolvedConfig& config, const std::vector<PixelSize>& machineSizes,
                          PixelSize otherwise) {
    DisplaySizes sizes;
    sizes.channels.resize(config.channels.size());
    for (size_t p = 0; p < config.pipes.size(); ++p) {
        const PixelSize machine = p < machineSizes.size() ? machineSizes[p] : otherwise;
        sizes.pipes.push_back(config.pipes[p].viewport.value_or(PixelViewport{0, 0, machine.w, machine.h}));
    }
    for (size_t w = 0; w < config.windows.size(); ++w) {
        sizes.windows.push_back(
            within(sizes.pipes[ResolvedConfig::at(config.windows[w].pipe)], config.windows[w].viewport));
        sizeChannels(config, static_cast<Index>(w), sizes);
    }
    return sizes;
}

void resizeWindow(const ResolvedConfig& config, Index window, PixelSize size, DisplaySizes& sizes) {
    PixelViewport& w = sizes.windows[ResolvedConfig::at(window)];
    w.w = size.w;
    w.h = size.h;
    sizeChannels(config, window, sizes);
}

} // namespace mural::compound
