#include "nodes/head/planning/compound_pass.hpp"

#include <algorithm>
#include <cmath>

namespace mural {

Zoom zoomOf(const config::ResolvedConfig& config, compound::Index compound) {
    Zoom zoom;
    for (compound::Index i = compound; i != config::kNone; i = config.compounds[config::ResolvedConfig::at(i)].parent)
        zoom = compose(zoom, config.compounds[config::ResolvedConfig::at(i)].zoom);
    return zoom;
}

double zoomChangeOf(const config::ResolvedConfig& config, const std::vector<compound::CompoundState>& states,
                    compound::Index compound) {
    double area = 1;
    for (compound::Index i = compound; i != config::kNone; i = config.compounds[config::ResolvedConfig::at(i)].parent) {
        const Zoom& file = config.compounds[config::ResolvedConfig::at(i)].zoom;
        const Zoom now = states[config::ResolvedConfig::at(i)].zoom.value_or(file);
        area *= now.x / file.x * (now.y / file.y);
    }
    return std::sqrt(area);
}

RenderPass passOf(const config::ResolvedConfig& config, const compound::RenderContext& c) {
    RenderPass p;
    p.eye = c.eye;
    p.kernelX = c.pixel.x;
    p.kernelY = c.pixel.y;
    p.kernelWidth = c.pixel.w;
    p.kernelHeight = c.pixel.h;
    p.sample = c.subPixel.index;
    p.samples = c.subPixel.size;
    p.phase = static_cast<int>(c.phase);
    p.period = static_cast<int>(c.period);
    p.share = c.range;
    const Zoom zoom = zoomOf(config, c.compound);
    p.zoom = {std::min(zoom.x, kMaxZoom), std::min(zoom.y, kMaxZoom)};
    return p;
}

} // namespace mural
