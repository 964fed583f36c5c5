#include "balancer/compound/plan_frame.hpp"

#include <algorithm>

#include "balancer/compound/frusta.hpp"
#include "balancer/compound/planner.hpp"

namespace mural::compound {

namespace {

// Returns true if an ancestor draws into the channel that executes this compound.
bool channelAbove(const ResolvedConfig& config, Index compound) {
    const Index own = config.compounds[at(compound)].executing;
    for (Index up = config.compounds[at(compound)].parent; up != kNone; up = config.compounds[at(up)].parent) {
        if (config.compounds[at(up)].executing == own) return true;
    }
    return false;
}

StereoMode stereoModeOf(const ResolvedConfig& config, const Inherited& i) {
    switch (i.attributes.stereoMode.value_or(config::value::kAuto)) {
    case config::value::kQuad: return StereoMode::Quad;
    case config::value::kAnaglyph: return StereoMode::Anaglyph;
    case config::value::kPassive: return StereoMode::Passive;
    default: break;
    }
    const config::ResolvedChannel& channel = config.channels[at(i.destination)];
    EyeSet eyes = i.eyes.value_or(kAllEyes);
    if (channel.isDestination()) eyes = eyes & config.segments[at(channel.segment)].eyes;
    if (!eyes.has(Eye::Left) || !eyes.has(Eye::Right)) return StereoMode::Passive;
    const config::WindowAttributes& window = config.windows[at(channel.window)].attributes;
    const bool quad = window.hintStereo == config::value::kOn && window.hintDrawable != config::value::kFbo;
    return quad ? StereoMode::Quad : StereoMode::Anaglyph;
}

// Selects the stereo buffer or the anaglyph colours. Only destinations show both eyes.
void setStereo(const ResolvedConfig& config, const Inherited& i, RenderContext& c) {
    c.stereoMode = stereoModeOf(config, i);
    if (c.eye == Eye::Cyclop) return;
    using config::ColorComponent;
    if (c.stereoMode == StereoMode::Anaglyph)
        c.eyeColors = c.eye == Eye::Left
                          ? i.attributes.anaglyphLeftMask.value_or(config::ColorMask{ColorComponent::Red})
                          : i.attributes.anaglyphRightMask.value_or(
                                config::ColorMask{ColorComponent::Green, ColorComponent::Blue});
    if (c.channel != c.destination) return;
    c.colorMask = c.eyeColors;
    if (c.stereoMode == StereoMode::Quad)
        c.drawBuffer = c.eye == Eye::Left ? DrawBuffer::BackLeft : DrawBuffer::BackRight;
}

} // namespace

FramePlan Planner::run() {
    for (const Index root : config_.roots) {
        for (const Eye eye : kEyes) pass(root, eye);
    }
    orderTasks(config_, input_.sizes, plan_);
    return std::move(plan_);
}

void Planner::pass(Index root, Eye eye) {
    active_.clear();
    activeOf_.assign(config_.compounds.size(), SIZE_MAX);
    activate(root, nullptr, eye);
    if (active_.empty()) return;
    linkFrames(eye);
    addQueues();
    emit(root);
}

void Planner::activate(Index compound, const Inherited* above, Eye eye) {
    const config::ResolvedCompound& c = config_.compounds[at(compound)];
    ActiveCompound active{compound, inherit(config_, input_, compound, above), {}, kNone};
    if (!isActive(config_, input_, compound, active.inherited, eye)) return;
    active.tasks = tasksOf(c, active.inherited, channelAbove(config_, compound));
    if (active.inherited.executing != kNone) joinBarrier(active);
    if (!active.tasks.empty()) active.context = contextOf(active, eye);
    activeOf_[at(compound)] = active_.size();
    active_.push_back(active);
    for (const Index child : c.children) activate(child, &active.inherited, eye);
}

void Planner::joinBarrier(const ActiveCompound& active) {
    const auto& barrier = config_.compounds[at(active.compound)].barrier;
    if (!barrier) return;
    auto found = std::find_if(plan_.barriers.begin(), plan_.barriers.end(),
                              [&](const PlannedBarrier& b) { return b.name == barrier->name; });
    if (found == plan_.barriers.end()) {
        plan_.barriers.push_back({barrier->name, barrier->nvGroup, barrier->nvBarrier, {}});
        found = std::prev(plan_.barriers.end());
    }
    const Index window = config_.channels[at(active.inherited.executing)].window;
    if (std::find(found->windows.begin(), found->windows.end(), window) == found->windows.end())
        found->windows.push_back(window);
}

Index Planner::contextOf(const ActiveCompound& active, Eye eye) {
    const Inherited& i = active.inherited;
    const config::ResolvedChannel& destination = config_.channels[at(i.destination)];
    RenderContext c;
    c.compound = active.compound;
    c.channel = i.executing;
    c.destination = i.destination;
    c.view = destination.view;
    c.eye = eye;
    c.taskId = static_cast<uint32_t>(plan_.contexts.size() + 1);
    c.area = i.area;
    c.viewport = i.area;
    if (c.channel != c.destination) {
        const PixelViewport& own = input_.sizes.channels[at(c.channel)];
        c.viewport.x = own.x;
        c.viewport.y = own.y;
    }
    const Viewport seen = coverage(config_, destination);
    c.part = compose(seen, i.part);
    c.x = i.x;
    c.y = i.y;
    const double w = i.whole.w, h = i.whole.h;
    const Viewport sampled = compose(i.own, {i.x.first() / w, i.y.first() / h, (i.x.last(i.area.w) - i.x.first()) / w,
                                             (i.y.last(i.area.h) - i.y.first()) / h});
    c.sampledPart = compose(seen, sampled);
    c.range = i.range;
    c.pixel = i.pixel;
    c.subPixel = i.subPixel;
    c.jitter = jitterOf(i.subPixel);
    c.zoom = i.zoom;
    c.period = i.period;
    c.phase = i.phase;
    c.overdraw = i.overdraw;
    c.buffers = i.buffers;
    setStereo(config_, i, c);
    const config::Screen screen =
        i.screen && c.channel != c.destination ? *i.screen : destinationScreen(config_, input_, i);
    setFrusta(screen, eyesOf(config_, input_, c.view, eye), i, sampled, input_, c);
    plan_.contexts.push_back(c);
    return static_cast<Index>(plan_.contexts.size()) - 1;
}

// Pre-order: clear, and draw for leaves. Post-order: assemble and read back.
void Planner::emit(Index compound) {
    const size_t index = activeOf_[at(compound)];
    if (index == SIZE_MAX) return;
    const ActiveCompound& active = active_[index]; // complete: emit() adds none
    if (active.tasks.has(Task::Clear)) add(active, Task::Clear);
    if (active.tasks.has(Task::Draw)) add(active, Task::Draw);
    for (const Index child : config_.compounds[at(compound)].children) emit(child);
    if (active.tasks.has(Task::Assemble)) add(active, Task::Assemble);
    if (active.tasks.has(Task::Readback)) add(active, Task::Readback);
}

void Planner::add(const ActiveCompound& active, Task kind) {
    const size_t index = activeOf_[at(active.compound)];
    PlannedTask task;
    task.kind = kind;
    task.context = active.context;
    if (kind == Task::Readback) task.outputs = outputs_[index];
    if (kind == Task::Assemble) task.inputs = inputs_[index];
    if (kind == Task::Readback && task.outputs.empty()) return; // no consumer
    if (kind == Task::Assemble && task.inputs.empty()) return;  // no producer in this frame
    if (kind == Task::Draw && !config_.compounds[at(active.compound)].inputQueues.empty()) {
        const auto queue = queues_.find(config_.compounds[at(active.compound)].inputQueues.front().name);
        if (queue == queues_.end()) return; // no queue: no work
        task.queue = queue->second;
    }
    const Index channel = active.inherited.executing;
    size_t& plan = channelPlans_[at(channel)];
    if (plan == SIZE_MAX) {
        plan = plan_.channels.size();
        plan_.channels.push_back({channel, {}});
    }
    plan_.channels[plan].tasks.push_back(std::move(task));
}

FramePlan planFrame(const ResolvedConfig& config, const FrameInput& input, FramePlan old) {
    if (input.sizes.channels.size() < config.channels.size()) {
        FrameInput complete = input;
        complete.sizes = displaySizes(config);
        return Planner(config, complete, std::move(old)).run();
    }
    return Planner(config, input, std::move(old)).run();
}

} // namespace mural::compound
