#include "native/runtime/frame_part.hpp"

#include <algorithm>

#include "nodes/player/pixel_mapping.hpp"
#include "nodes/player/raster_bins.hpp"

namespace mural::native {

namespace {

// This node's part of the window.
PixelViewport partOf(const PlayerConfig& config, const ViewportAssignment* areas, const PixelViewport& whole) {
    if (areas) {
        const auto node = static_cast<size_t>(config.node);
        if (node >= areas->ofNodes.size()) return {};
        return intersect(apply(whole, areas->ofNodes[node]), whole);
    }
    if (config.area) return intersect(apply(whole, *config.area), whole);
    return regionViewport(config.grid, config.region, whole.w, whole.h);
}

} // namespace

FramePart framePartOf(const PlayerConfig& config, const ViewportAssignment* areas, const Range& share, int32_t width,
                      int32_t height, uint32_t frame, int samples) {
    FramePart part;
    part.pass = config.pass;
    part.pass.share = share;
    if (areas && config.movesZoom) {
        const double zoom = areas->zoomOf(static_cast<size_t>(config.node));
        part.pass.zoom = {part.pass.zoom.x * zoom, part.pass.zoom.y * zoom};
    }
    part.areas = areas ? areas->number : 0;
    const PixelViewport whole{0, 0, width, height};
    const PixelViewport own = partOf(config, areas, whole);
    const bool hasTurn = static_cast<int>(frame % static_cast<uint32_t>(config.pass.period)) == config.pass.phase;
    const bool collects = config.pass.ranges <= 1 || config.pass.range == 0;
    part.picture = inShown(part.pass, whole);
    part.drawnWhole = inPass(part.pass, whole);
    if (hasTurn) part.drawn = inPass(part.pass, own);
    if (hasTurn && collects) part.shown = inShown(part.pass, own);
    // The zoom of the setup is the largest one, so the size of the framebuffer does not change with the zooms.
    const PixelViewport largest = inPass(config.pass, whole);
    part.surface = {0, 0, std::max({part.picture.w, largest.w, 1}), std::max({part.picture.h, largest.h, 1})};
    part.scissor = part.drawn;
    if (samples > 0 && !part.drawn.empty())
        part.scissor = intersect(widenToBins(part.drawn, part.surface), part.drawnWhole);

    RenderContext& c = part.context;
    c.area = part.drawn;
    c.picture = part.drawnWhole;
    if (!part.drawnWhole.empty()) c.part = relativeTo(part.drawn, part.drawnWhole);
    c.range = config.pass.ranges > 1 ? share : Range{};
    c.eye = part.pass.eye;
    c.pixel = {part.pass.kernelX, part.pass.kernelY, part.pass.kernelWidth, part.pass.kernelHeight};
    c.subPixel = {part.pass.sample, part.pass.samples};
    c.zoom = part.pass.zoom;
    c.period = static_cast<uint32_t>(part.pass.period);
    c.phase = static_cast<uint32_t>(part.pass.phase);
    c.node = config.node;
    return part;
}

} // namespace mural::native
