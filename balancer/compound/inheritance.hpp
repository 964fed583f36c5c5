// What a compound has from those above it and from itself, in one frame.
#pragma once

#include "balancer/compound/render_context.hpp"
#include "balancer/config/screen.hpp"

namespace mural::compound {

struct Inherited {
    Index destination = kNone; // the first channel from the root
    Index executing = kNone;   // the nearest one
    PixelViewport area;        // in the destination's window; after pixel kernel and zoom
    Viewport part;             // of the destination
    Viewport own;              // of the destination: what all of its pixels show
    PixelSize whole;           // pixels of the destination, overdraw included
    PixelAxis x, y;
    Range range;
    PixelKernel pixel;
    SubPixel subPixel;
    Zoom zoom;
    std::optional<EyeSet> eyes;
    uint32_t period = 1;
    uint32_t phase = 0;
    config::BufferSet buffers{config::Buffer::Color};
    config::CompoundAttributes attributes;
    std::optional<config::Screen> screen; // explicit, instead of the destination's
    Overdraw overdraw;
};

// above: null for roots.
Inherited inherit(const ResolvedConfig& config, const FrameInput& input, Index compound, const Inherited* above);

// Does the compound do something for this eye?
bool isActive(const ResolvedConfig& config, const FrameInput& input, Index compound, const Inherited& inherited, Eye eye);

// `channelAbove`: of those above, does one use the channel that executes this compound?
config::TaskSet tasksOf(const config::ResolvedCompound& compound, const Inherited& inherited, bool channelAbove);

// Is the view's layout shown on the canvas of this segment?
bool isShown(const ResolvedConfig& config, const FrameInput& input, Index segment, Index view);

} // namespace mural::compound
