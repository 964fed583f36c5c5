#include "tools/mural/config/plan_text.hpp"

#include <fmt/format.h>

namespace mural::cli {

namespace {

using namespace compound;

const char* wordOf(Task task) {
    switch (task) {
    case Task::Clear: return "clear";
    case Task::Draw: return "draw";
    case Task::Assemble: return "assemble";
    case Task::Readback: return "readback";
    }
    return "";
}

std::string called(const char* what, const std::string& name, Index index) {
    return name.empty() ? fmt::format("{} {}", what, index) : fmt::format("{} \"{}\"", what, name);
}

std::string areaText(const PixelViewport& v) { return fmt::format("[ {} {} {} {} ]", v.x, v.y, v.w, v.h); }
std::string partText(const Viewport& v) { return fmt::format("[ {:.6g} {:.6g} {:.6g} {:.6g} ]", v.x, v.y, v.w, v.h); }
std::string frustumText(const Frustum& f) {
    return fmt::format("[ {:.6g} {:.6g} {:.6g} {:.6g} ]", f.left, f.right, f.bottom, f.top);
}

std::string buffersText(config::BufferSet buffers) {
    std::string text = buffers.has(config::Buffer::Color) ? "color" : "";
    if (buffers.has(config::Buffer::Depth)) text += text.empty() ? "depth" : " and depth";
    return text;
}

// Prints the attributes of a context that differ from the defaults.
std::string contextText(const RenderContext& c) {
    std::string text = fmt::format("eye {} pixels {} part {}", nameOf(c.eye), areaText(c.viewport), partText(c.part));
    if (c.viewport.x != c.area.x || c.viewport.y != c.area.y)
        text += fmt::format(" offset [ {} {} ]", c.area.x, c.area.y);
    if (!c.range.full()) text += fmt::format(" range [ {:.6g} {:.6g} ]", c.range.start, c.range.end);
    if (!c.pixel.whole()) text += fmt::format(" pixel [ {} {} {} {} ]", c.pixel.x, c.pixel.y, c.pixel.w, c.pixel.h);
    if (!c.subPixel.whole())
        text += fmt::format(" subpixel [ {} {} ] jitter [ {:.4g} {:.4g} ]", c.subPixel.index, c.subPixel.size,
                            c.jitter.x, c.jitter.y);
    if (!c.zoom.none()) text += fmt::format(" zoom [ {:.4g} {:.4g} ]", c.zoom.x, c.zoom.y);
    if (c.period > 1) text += fmt::format(" phase {} period {}", c.phase, c.period);
    return text;
}

std::string stereoText(const RenderContext& c) {
    if (c.drawBuffer != DrawBuffer::Back)
        return c.drawBuffer == DrawBuffer::BackLeft ? " into the left buffer" : " into the right buffer";
    using config::ColorComponent;
    if (c.colorMask.has(ColorComponent::Red) && c.colorMask.has(ColorComponent::Green) &&
        c.colorMask.has(ColorComponent::Blue))
        return {};
    std::string mask;
    if (c.colorMask.has(ColorComponent::Red)) mask += " red";
    if (c.colorMask.has(ColorComponent::Green)) mask += " green";
    if (c.colorMask.has(ColorComponent::Blue)) mask += " blue";
    return " only" + (mask.empty() ? " nothing" : mask);
}

std::string taskText(const FramePlan& plan, const PlannedTask& task) {
    const RenderContext& c = plan.contexts[at(task.context)];
    std::string text = fmt::format("    {:<9}{}", wordOf(task.kind), contextText(c));
    if (task.kind != Task::Readback) text += stereoText(c);
    if (task.kind == Task::Draw) text += " frustum " + frustumText(c.perspective);
    if (task.queue != kNone) text += " tiles of " + plan.queues[at(task.queue)].name;
    text += "\n";
    for (const Index f : task.outputs) {
        const PlannedFrame& frame = plan.frames[at(f)];
        text += fmt::format("             gives \"{}\": {} of {}", frame.name, buffersText(frame.buffers),
                            areaText(frame.area));
        if (!frame.zoom.none()) text += fmt::format(" as {}x{}", frame.size.w, frame.size.h);
        text += fmt::format("{}{}\n", frame.type == config::FrameType::Texture ? ", as a texture" : "",
                            frame.codec != "auto" ? ", codec " + frame.codec : "");
    }
    for (const FrameUse& use : task.inputs) {
        text += fmt::format("             takes \"{}\" to {} {}", plan.frames[at(use.frame)].name, use.x, use.y);
        if (!use.kernel.whole())
            text += fmt::format(" pixel [ {} {} {} {} ]", use.kernel.x, use.kernel.y, use.kernel.w, use.kernel.h);
        if (!use.zoom.none()) text += fmt::format(" zoom [ {:.4g} {:.4g} ]", use.zoom.x, use.zoom.y);
        text += "\n";
    }
    return text;
}

} // namespace

std::string planText(const config::ResolvedConfig& config, const FramePlan& plan) {
    std::string text = fmt::format("frame {}\n", plan.frameNumber);
    for (const ChannelPlan& c : plan.channels) {
        const config::ResolvedChannel& channel = config.channels[at(c.channel)];
        text += fmt::format("channel \"{}\"", channel.name);
        if (channel.isDestination()) {
            const config::ResolvedView& v = config.views[at(channel.view)];
            text += fmt::format(", {} on {}", called("layout", config.layouts[at(v.layout)].name, v.layout),
                                called("segment", config.segments[at(channel.segment)].name, channel.segment));
        }
        text += "\n";
        for (const PlannedTask& task : c.tasks) text += taskText(plan, task);
    }
    for (const PlannedQueue& q : plan.queues) text += fmt::format("queue {}: {} tiles\n", q.name, q.tiles.size());
    for (const PlannedBarrier& b : plan.barriers)
        text += fmt::format("barrier \"{}\": {} windows\n", b.name, b.windows.size());
    if (plan.interleaved) text += "channels of one window wait for each other: each needs its own buffer\n";
    return text;
}

} // namespace mural::cli
