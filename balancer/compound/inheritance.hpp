// Effective attributes of a compound in one frame: inherited from its ancestors and set by itself.
#pragma once

#include "balancer/compound/render_context.hpp"
#include "balancer/config/screen.hpp"

namespace mural::compound {

struct Inherited {
    Index destination = kNone; // first channel on the path from the root
    Index executing = kNone;   // nearest channel
    PixelViewport area;        // in the destination's window, after pixel kernel and zoom
    Viewport part;             // relative to the destination
    Viewport own;              // relative to the destination: the part represented by all of its pixels
    PixelSize whole;           // pixels of the destination including overdraw
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
    std::optional<config::Screen> screen; // set by the compound; overrides the destination's screen
    Overdraw overdraw;
};

// Returns the effective attributes. `above`: those of the parent; null for a root.
Inherited inherit(const ResolvedConfig& config, const FrameInput& input, Index compound, const Inherited* above);

// Returns true if the compound has tasks for this eye.
bool isActive(const ResolvedConfig& config, const FrameInput& input, Index compound, const Inherited& inherited,
              Eye eye);

// Returns the tasks of a compound. `channelAbove`: an ancestor uses the channel that executes this compound.
config::TaskSet tasksOf(const config::ResolvedCompound& compound, const Inherited& inherited, bool channelAbove);

// Returns true if the canvas of this segment shows the layout of the view.
bool isShown(const ResolvedConfig& config, const FrameInput& input, Index segment, Index view);

} // namespace mural::compound
