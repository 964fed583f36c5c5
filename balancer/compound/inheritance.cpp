#include "balancer/compound/inheritance.hpp"

namespace mural::compound {

namespace {

const CompoundState& stateOf(const FrameInput& input, Index compound) {
    static const CompoundState kUnchanged;
    return at(compound) < input.compounds.size() ? input.compounds[at(compound)] : kUnchanged;
}

ViewState stateOfView(const FrameInput& input, Index view) {
    return at(view) < input.views.size() ? input.views[at(view)] : ViewState{};
}

// The first channel on the path from the root becomes the destination of the whole subtree.
void beginDestination(const ResolvedConfig& config, const FrameInput& input, Index channel, const Viewport& own,
                      Inherited& i) {
    i.destination = channel;
    i.area = input.sizes.channels[at(channel)];
    const Index view = config.channels[at(channel)].view;
    if (view != kNone) i.overdraw = stateOfView(input, view).overdraw;
    i.area.w += i.overdraw.left + i.overdraw.right;
    i.area.h += i.overdraw.bottom + i.overdraw.top;
    i.whole = {i.area.w, i.area.h};
    i.own = compose(i.own, own);
    i.part = i.own;
}

void applyViewport(const Viewport& viewport, Inherited& i) {
    const PixelViewport before = i.area;
    i.area = apply(i.area, viewport);
    i.x.origin += i.x.scale * i.x.step * (i.area.x - before.x);
    i.y.origin += i.y.scale * i.y.step * (i.area.y - before.y);
    if (!before.empty()) i.part = compose(i.part, relativeTo(i.area, before));
}

void applyKernel(const PixelKernel& kernel, Inherited& i) {
    if (kernel.whole()) return;
    i.area = apply(i.area, kernel);
    i.x.kernel += i.x.step * kernel.x;
    i.x.step *= kernel.w;
    i.y.kernel += i.y.step * kernel.y;
    i.y.step *= kernel.h;
}

void applyZoom(const Zoom& zoom, Inherited& i) {
    if (zoom.none()) return;
    const PixelViewport before = i.area;
    i.area = apply(i.area, zoom);
    if (i.area.empty() || before.empty()) return;
    const Zoom exact{i.area.w / double(before.w), i.area.h / double(before.h)}; // rounded to whole pixels
    i.zoom = compose(i.zoom, exact);
    i.x.scale /= exact.x;
    i.y.scale /= exact.y;
}

bool hasEye(const ResolvedConfig& config, const FrameInput& input, const config::ResolvedChannel& channel, Eye eye) {
    const config::ViewMode mode = stateOfView(input, channel.view).mode.value_or(config.views[at(channel.view)].mode);
    if (mode == config::ViewMode::Mono) return eye == Eye::Cyclop;
    return eye != Eye::Cyclop && config.segments[at(channel.segment)].eyes.has(eye);
}

} // namespace

Inherited inherit(const ResolvedConfig& config, const FrameInput& input, Index compound, const Inherited* above) {
    const config::ResolvedCompound& c = config.compounds[at(compound)];
    const CompoundState& state = stateOf(input, compound);
    const Viewport viewport = state.viewport.value_or(c.viewport);
    Inherited i = above != nullptr ? *above : Inherited{};
    if (c.channel != kNone) i.executing = c.channel;
    if (i.destination != kNone)
        applyViewport(viewport, i);
    else if (c.channel != kNone)
        beginDestination(config, input, c.channel, viewport, i);
    else
        i.own = compose(i.own, viewport);
    i.range = compose(i.range, state.range.value_or(c.range));
    i.pixel = compose(i.pixel, c.pixel);
    i.subPixel = compose(i.subPixel, c.subPixel);
    if (c.eyes) i.eyes = c.eyes;
    if (c.period) i.period = *c.period;
    if (c.phase) i.phase = *c.phase;
    if (c.buffers) i.buffers = *c.buffers;
    if (c.attributes.stereoMode) i.attributes.stereoMode = c.attributes.stereoMode;
    if (c.attributes.anaglyphLeftMask) i.attributes.anaglyphLeftMask = c.attributes.anaglyphLeftMask;
    if (c.attributes.anaglyphRightMask) i.attributes.anaglyphRightMask = c.attributes.anaglyphRightMask;
    if (c.surface) i.screen = config::screenOf(*c.surface);
    applyKernel(c.pixel, i);
    applyZoom(state.zoom.value_or(c.zoom), i);
    return i;
}

bool isShown(const ResolvedConfig& config, const FrameInput& input, Index segment, Index view) {
    const Index canvas = config.segments[at(segment)].canvas;
    const auto& layouts = config.canvases[at(canvas)].layouts;
    const Index active = at(canvas) < input.activeLayouts.size() ? input.activeLayouts[at(canvas)] : 0;
    return active >= 0 && at(active) < layouts.size() && layouts[at(active)] == config.views[at(view)].layout;
}

bool isActive(const ResolvedConfig& config, const FrameInput& input, Index compound, const Inherited& i, Eye eye) {
    if (!stateOf(input, compound).active || input.frameNumber % i.period != i.phase) return false;
    if (i.eyes && !i.eyes->has(eye)) return false;
    if (i.destination == kNone) return true; // no channel yet: descendants decide
    const config::ResolvedChannel& channel = config.channels[at(i.destination)];
    if (!channel.isDestination()) return i.eyes ? true : eye == Eye::Cyclop;
    return isShown(config, input, channel.segment, channel.view) && hasEye(config, input, channel, eye);
}

config::TaskSet tasksOf(const config::ResolvedCompound& c, const Inherited& i, bool channelAbove) {
    if (i.executing == kNone || i.area.empty() || i.range.empty()) return {};
    using config::Task;
    config::TaskSet tasks{Task::Clear, Task::Assemble, Task::Readback};
    if (c.tasks) {
        tasks = *c.tasks;
    } else if (c.isLeaf()) {
        tasks.add(Task::Draw);
        if (channelAbove) tasks.remove(Task::Clear);
    }
    if (!c.isLeaf()) tasks.remove(Task::Draw);
    if (c.outputFrames.empty()) tasks.remove(Task::Readback);
    if (c.inputFrames.empty()) tasks.remove(Task::Assemble);
    return tasks;
}

} // namespace mural::compound
