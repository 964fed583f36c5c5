// What every channel does in one frame, and the pictures that they hand to each other for it.
#pragma once

#include "balancer/compound/render_context.hpp"

namespace mural::compound {

using config::Task;

// A picture on its way from the channel that reads it back to those that put it into theirs.
struct PlannedFrame {
    std::string name;
    Index compound = kNone; // which hands it out
    Index channel = kNone;
    Eye eye = Eye::Cyclop;
    config::FrameType type = config::FrameType::Memory;
    config::BufferSet buffers;
    std::string codec;
    bool exact = true;
    PixelViewport area; // that is read back, in the window of the channel
    PixelSize size;     // of the picture: the area, made smaller by `zoom`
    Zoom zoom;
    Range range;
    PixelKernel pixel;
    SubPixel subPixel;
    bool perTile = false; // one picture for each tile that was taken from a queue
    std::vector<Index> consumers; // channels
};

struct FrameUse {
    Index frame = kNone;
    // Where the picture's first pixel goes in the consumer's window, and which pixels follow it: pixel i stands at
    // x + kernel.x + kernel.w · i, enlarged by zoom.
    int32_t x = 0;
    int32_t y = 0;
    PixelKernel kernel;
    Zoom zoom;
    PixelViewport clip; // nothing outside of it is touched
    std::string codec;  // otherwise the frame's
    bool exact = true;
};

struct PlannedTask {
    Task kind = Task::Clear;
    Index context = kNone;          // in FramePlan::contexts
    std::vector<Index> outputs;     // of Readback: in FramePlan::frames
    // Of Assemble. When one of them was read back from this channel, it stands for what is there: that is replaced.
    std::vector<FrameUse> inputs;
    Index queue = kNone;            // of Draw: takes its work from it; in FramePlan::queues
};

// Pieces of one picture, taken by whoever is free.
struct PlannedTile {
    PixelViewport area; // in the destination's window
    Viewport part;      // of the context that the queue belongs to
    Range range;        // likewise
};

struct PlannedQueue {
    std::string name;
    Index context = kNone; // that is divided
    std::vector<PlannedTile> tiles;
};

struct ChannelPlan {
    Index channel = kNone;
    std::vector<PlannedTask> tasks; // in their order
};

struct PlannedBarrier {
    std::string name;
    config::Attribute nvGroup, nvBarrier;
    std::vector<Index> windows;
};

// One task of a pipe: which channel's, and which of its tasks.
struct PipeStep {
    size_t channel = 0; // in FramePlan::channels
    size_t task = 0;
};

struct FramePlan {
    uint64_t frameNumber = 0;
    std::vector<RenderContext> contexts;
    std::vector<PlannedFrame> frames;
    std::vector<PlannedQueue> queues;
    std::vector<ChannelPlan> channels; // those that have something to do
    std::vector<PlannedBarrier> barriers;
    // Of each pipe: its channels' tasks in an order in which none waits for a later one of the same pipe. Channels that
    // share pixels of a window come one after the other; where frames forbid that, `interleaved` says that each of them
    // needs a buffer of its own.
    std::vector<std::vector<PipeStep>> pipes;
    bool interleaved = false;
    // Where there is no such order: the frames that wait for each other. Then `pipes` is empty.
    std::vector<Index> deadlock;
};

} // namespace mural::compound
