// A configuration whose names are looked up: everything stands in flat lists and refers to others by index. What the
// file left out has its default; destination channels and the compounds that follow from canvases are there.
#pragma once

#include "balancer/config/config.hpp"

namespace mural::config {

using Index = int32_t;
inline constexpr Index kNone = -1;

struct ResolvedNode {
    bool isApplication = false;
    std::string name;
    std::string host; // empty: this machine
    std::vector<Connection> connections; // complete
    NodeAttributes attributes;           // complete
    std::vector<Index> pipes;
    SourcePosition at;
};

struct ResolvedPipe {
    Index node = kNone;
    std::string name;
    std::optional<uint32_t> port, device;
    std::optional<PixelViewport> viewport; // otherwise the machine's
    PipeAttributes attributes;
    std::vector<Index> windows;
    SourcePosition at;
};

struct ResolvedWindow {
    Index pipe = kNone;
    std::string name;
    Viewport viewport; // pixels or part of the pipe: inPixels()
    WindowAttributes attributes;
    std::vector<Index> channels; // those that the file names, then destination channels
    SourcePosition at;
};

struct ResolvedChannel {
    Index window = kNone;
    std::string name;
    Viewport viewport; // pixels or part of the window: inPixels()
    ChannelAttributes attributes;
    // Of a destination channel: what it shows. Channels that the file names have none.
    Index segment = kNone;
    Index view = kNone;
    SourcePosition at;
    [[nodiscard]] bool isDestination() const { return view != kNone; }
};

struct ResolvedObserver {
    std::string name;
    Vector3 eyeLeft, eyeCyclop, eyeRight;
    double focusDistance = 1;
    FocusMode focusMode = FocusMode::Fixed;
    int32_t opencvCamera = value::kOff;
    std::string vrpnTracker;
    SourcePosition at;
};

struct ResolvedView {
    Index layout = kNone;
    std::string name;
    ViewMode mode = ViewMode::Mono;
    Viewport viewport;
    std::optional<ProjectionSurface> surface; // instead of the segments'
    Index observer = kNone;
    std::string deflectHost;
    SourcePosition at;
};

struct ResolvedLayout {
    std::string name;
    std::vector<Index> views;
    SourcePosition at;
};

struct ResolvedBarrier {
    std::string name;
    Attribute nvGroup, nvBarrier;
};

struct ResolvedSegment {
    Index canvas = kNone;
    std::string name;
    Index channel = kNone;     // as the file names it
    std::vector<Index> copies; // other channels that show the same picture
    EyeSet eyes = kAllEyes;
    Viewport viewport; // of the canvas: what is seen, without bezels
    Viewport outer;    // with them
    ProjectionSurface surface; // its own, or the canvas'
    Viewport surfacePart;      // what of the surface it shows
    std::optional<ResolvedBarrier> barrier;
    SourcePosition at;
};

struct ResolvedCanvas {
    std::string name;
    std::vector<Index> layouts; // kNone: nothing is shown. The first one is shown first.
    ProjectionSurface surface;
    std::vector<Index> segments;
    SourcePosition at;
};

struct ResolvedFrame {
    std::string name;
    FrameType type = FrameType::Memory;
    Viewport viewport;
    std::optional<BufferSet> buffers; // otherwise the compound's
    std::optional<Zoom> zoom;         // otherwise what follows from the compounds
    std::string codec = "auto";
    bool exact = true;
    SourcePosition at;
};

struct ResolvedQueue {
    std::string name;
    PixelsOrRange size; // of output queues: one of them is set
    SourcePosition at;
};

struct ResolvedCompound {
    Index parent = kNone;
    std::vector<Index> children;
    std::string name;
    Index channel = kNone;     // its own
    Index executing = kNone;   // its own, or the nearest above
    Index destination = kNone; // the first one from the root
    std::optional<TaskSet> tasks;
    std::optional<EyeSet> eyes;
    std::optional<BufferSet> buffers;
    Viewport viewport;
    Range range;
    std::optional<uint32_t> period, phase;
    Zoom zoom;
    PixelKernel pixel;
    SubPixel subPixel;
    std::string composition; // its own, or the nearest above; empty: nothing is said
    std::optional<ProjectionSurface> surface;
    CompoundAttributes attributes; // its own; of roots: complete
    std::vector<Equalizer> equalizers;
    std::optional<ResolvedBarrier> barrier;
    std::vector<ResolvedQueue> outputQueues, inputQueues;
    std::vector<ResolvedFrame> outputFrames, inputFrames;
    bool isGenerated = false; // not in the file
    SourcePosition at;
    [[nodiscard]] bool isLeaf() const { return children.empty(); }
};

struct ResolvedConfig {
    std::string name;
    uint32_t latency = 1; // frames
    double eyeBase = .05; // metres
    int32_t robustness = value::kAuto;
    std::vector<Connection> serverConnections; // complete
    std::vector<ResolvedNode> nodes;           // the application's first
    std::vector<ResolvedPipe> pipes;
    std::vector<ResolvedWindow> windows;
    std::vector<ResolvedChannel> channels;
    std::vector<ResolvedObserver> observers;
    std::vector<ResolvedLayout> layouts;
    std::vector<ResolvedView> views;
    std::vector<ResolvedCanvas> canvases;
    std::vector<ResolvedSegment> segments;
    std::vector<ResolvedCompound> compounds;
    std::vector<Index> roots; // of the compounds' trees, in the order in which they are drawn

    // An index always stands in its list: resolve() is the only one who makes them.
    [[nodiscard]] const ResolvedPipe& pipeOf(const ResolvedChannel& c) const { return pipes[at(windows[at(c.window)].pipe)]; }
    [[nodiscard]] static size_t at(Index index) { return static_cast<size_t>(index); }
};

[[nodiscard]] inline size_t at(Index index) { return ResolvedConfig::at(index); }

} // namespace mural::config
