// A configuration with resolved names: flat lists whose entries refer to each other by index. Omitted values have their
// defaults. Destination channels, and the compounds that follow from canvases, exist.
#pragma once

#include "balancer/config/config.hpp"

namespace mural::config {

using Index = int32_t;
inline constexpr Index kNone = -1;

struct ResolvedNode {
    bool isApplication = false;
    std::string name;
    std::string host;                    // empty: this machine
    std::vector<Connection> connections; // all fields set
    NodeAttributes attributes;           // all fields set
    std::vector<Index> pipes;
    SourcePosition at;
};

struct ResolvedPipe {
    Index node = kNone;
    std::string name;
    std::optional<uint32_t> port, device;
    std::optional<PixelViewport> viewport; // empty: the machine's screen
    PipeAttributes attributes;
    std::vector<Index> windows;
    SourcePosition at;
};

struct ResolvedWindow {
    Index pipe = kNone;
    std::string name;
    Viewport viewport; // in pixels, or relative to the pipe: inPixels()
    WindowAttributes attributes;
    std::vector<Index> channels; // channels of the file, then destination channels
    SourcePosition at;
};

struct ResolvedChannel {
    Index window = kNone;
    std::string name;
    Viewport viewport; // in pixels, or relative to the window: inPixels()
    ChannelAttributes attributes;
    // Destination channels only: the segment and view that they show.
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
    std::optional<ProjectionSurface> surface; // overrides the segments' surfaces
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
    Index channel = kNone;     // the channel that the file names
    std::vector<Index> copies; // other channels with the same picture
    EyeSet eyes = kAllEyes;
    Viewport viewport;         // visible part of the canvas, without bezels
    Viewport outer;            // part of the canvas including bezels
    ProjectionSurface surface; // its own, or the canvas'
    Viewport surfacePart;      // the part of the surface that it shows
    std::optional<ResolvedBarrier> barrier;
    SourcePosition at;
};

struct ResolvedCanvas {
    std::string name;
    std::vector<Index> layouts; // kNone: dark; the first layout is active initially
    ProjectionSurface surface;
    std::vector<Index> segments;
    SourcePosition at;
};

struct ResolvedFrame {
    std::string name;
    FrameType type = FrameType::Memory;
    Viewport viewport;
    std::optional<BufferSet> buffers; // empty: the compound's
    std::optional<Zoom> zoom;         // empty: derived from the compounds
    std::string codec = "auto";
    bool exact = true;
    SourcePosition at;
};

struct ResolvedQueue {
    std::string name;
    PixelsOrRange size; // output queues only; one of its members is set
    SourcePosition at;
};

struct ResolvedCompound {
    Index parent = kNone;
    std::vector<Index> children;
    std::string name;
    Index channel = kNone;     // its own
    Index executing = kNone;   // its own, or the nearest ancestor's
    Index destination = kNone; // the first channel on the path from the root
    std::optional<TaskSet> tasks;
    std::optional<EyeSet> eyes;
    std::optional<BufferSet> buffers;
    Viewport viewport;
    Range range;
    std::optional<uint32_t> period, phase;
    Zoom zoom;
    PixelKernel pixel;
    SubPixel subPixel;
    std::string composition; // its own, or the nearest ancestor's; empty: not stated
    std::optional<ProjectionSurface> surface;
    CompoundAttributes attributes; // its own; all fields set for roots
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
    uint32_t latency = 1; // in frames
    double eyeBase = .05; // in metres
    int32_t robustness = value::kAuto;
    std::vector<Connection> serverConnections; // all fields set
    std::vector<ResolvedNode> nodes;           // the application's node first
    std::vector<ResolvedPipe> pipes;
    std::vector<ResolvedWindow> windows;
    std::vector<ResolvedChannel> channels;
    std::vector<ResolvedObserver> observers;
    std::vector<ResolvedLayout> layouts;
    std::vector<ResolvedView> views;
    std::vector<ResolvedCanvas> canvases;
    std::vector<ResolvedSegment> segments;
    std::vector<ResolvedCompound> compounds;
    std::vector<Index> roots; // roots of the compound trees, in drawing order

    // Indices are always valid: only resolve() creates them.
    [[nodiscard]] const ResolvedPipe& pipeOf(const ResolvedChannel& c) const {
        return pipes[at(windows[at(c.window)].pipe)];
    }
    [[nodiscard]] static size_t at(Index index) { return static_cast<size_t>(index); }
};

[[nodiscard]] inline size_t at(Index index) { return ResolvedConfig::at(index); }

} // namespace mural::config
