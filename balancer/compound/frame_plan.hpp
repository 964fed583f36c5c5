// The plan of one frame: the tasks of every channel, and the frames that channels exchange.
#pragma once

#include "balancer/compound/render_context.hpp"

namespace mural::compound {

using config::Task;

// A picture on its way from the channel that reads it back to the channels that assemble it.
struct PlannedFrame {
    std::string name;
    Index compound = kNone; // producer
    Index channel = kNone;
    Eye eye = Eye::Cyclop;
    config::FrameType type = config::FrameType::Memory;
    config::BufferSet buffers;
    std::string codec;
    bool exact = true;
    PixelViewport area; // readback area in the channel's window
    PixelSize size;     // size of the picture: the area scaled by `zoom`
    Zoom zoom;
    Range range;
    PixelKernel pixel;
    SubPixel subPixel;
    bool perTile = false;         // one picture per tile taken from a queue
    std::vector<Index> consumers; // channel indices
};

struct FrameUse {
    Index frame = kNone;
    // Place of the picture in the consumer's window: pixel i is at x + kernel.x + kernel.w * i, scaled by zoom.
    int32_t x = 0;
    int32_t y = 0;
    PixelKernel kernel;
    Zoom zoom;
    PixelViewport clip; // assembly changes no pixel outside
    std::string codec;  // empty: the codec of the frame
    bool exact = true;
};

struct PlannedTask {
    Task kind = Task::Clear;
    Index context = kNone;      // index into FramePlan::contexts
    std::vector<Index> outputs; // Readback only: indices into FramePlan::frames
    // Assemble only. A frame that was read back from this channel replaces the contents of its readback area.
    std::vector<FrameUse> inputs;
    Index queue = kNone; // Draw only: source of its work; index into FramePlan::queues
};

// One work item of a tile or chunk queue.
struct PlannedTile {
    PixelViewport area; // in the destination's window
    Viewport part;      // relative to the context of the queue
    Range range;        // relative to the context of the queue
};

struct PlannedQueue {
    std::string name;
    Index context = kNone; // context that the queue divides
    std::vector<PlannedTile> tiles;
};

struct ChannelPlan {
    Index channel = kNone;
    std::vector<PlannedTask> tasks; // in execution order
};

struct PlannedBarrier {
    std::string name;
    config::Attribute nvGroup, nvBarrier;
    std::vector<Index> windows;
};

// One task of a pipe: a channel and the index of its task.
struct PipeStep {
    size_t channel = 0; // index into FramePlan::channels
    size_t task = 0;
};

struct FramePlan {
    uint64_t frameNumber = 0;
    std::vector<RenderContext> contexts;
    std::vector<PlannedFrame> frames;
    std::vector<PlannedQueue> queues;
    std::vector<ChannelPlan> channels; // channels with at least one task
    std::vector<PlannedBarrier> barriers;
    // Per pipe: the tasks of its channels in an order without waits for a later task of the same pipe. Channels that
    // share pixels of a window run one after the other. Where frames forbid that, `interleaved` marks channels that
    // need a buffer of their own.
    std::vector<std::vector<PipeStep>> pipes;
    bool interleaved = false;
    // The frames of a cycle, if no such order exists. `pipes` is empty then.
    std::vector<Index> deadlock;
};

} // namespace mural::compound
