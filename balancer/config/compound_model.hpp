// The model of compounds: trees, the frames that compounds exchange, queues, barriers, equalizers.
#pragma once

#include <array>

#include "balancer/config/display.hpp"
#include "common/geometry/pixel_kernel.hpp"
#include "common/geometry/range.hpp"
#include "common/geometry/sub_pixel.hpp"
#include "common/geometry/zoom.hpp"

namespace mural::config {

enum class Task : uint8_t { Clear, Draw, Assemble, Readback };
using TaskSet = EnumSet<Task>;

enum class Buffer : uint8_t { Color, Depth };
using BufferSet = EnumSet<Buffer>;

enum class ColorComponent : uint8_t { Red, Green, Blue };
using ColorMask = EnumSet<ColorComponent>;

enum class FrameType : uint8_t {
    Memory,
    Texture, // stays on the GPU; only between channels of one pipe
};

// An output frame, read back under a name, or an input frame, assembled from the output frames of the same name.
struct Frame {
    std::optional<std::string> name;
    std::optional<FrameType> type;
    std::optional<Viewport> viewport;
    std::optional<BufferSet> buffers;
    std::optional<Zoom> zoom;
    std::optional<std::string> codec; // codec name, or "auto"
    Attribute exact;                  // OFF allows lossy codecs
    SourcePosition at;
    friend bool operator==(const Frame&, const Frame&) = default;
};

struct Pixels2 {
    uint32_t x = 0;
    uint32_t y = 0;
    friend constexpr bool operator==(const Pixels2&, const Pixels2&) = default;
};

// A size in pixels for 2D and as a fraction for ranges. A file may give both.
struct PixelsOrRange {
    std::optional<Pixels2> pixels;
    std::optional<double> range;
    friend bool operator==(const PixelsOrRange&, const PixelsOrRange&) = default;
};

// A queue of work items that idle channels take: tiles of pixels, or chunks of the range.
struct TileQueue {
    std::optional<std::string> name;
    PixelsOrRange size;
    SourcePosition at;
    friend bool operator==(const TileQueue&, const TileQueue&) = default;
};

enum class SplitMode : uint8_t { TwoD, Db, Horizontal, Vertical };

struct LoadEqualizer {
    std::optional<SplitMode> mode;
    std::optional<double> damping;
    std::optional<double> assembleOnlyLimit;
    PixelsOrRange boundary, resistance;
    SourcePosition at;
    friend bool operator==(const LoadEqualizer&, const LoadEqualizer&) = default;
};

struct TreeEqualizer {
    std::optional<SplitMode> mode;
    std::optional<double> damping;
    PixelsOrRange boundary, resistance;
    SourcePosition at;
    friend bool operator==(const TreeEqualizer&, const TreeEqualizer&) = default;
};

struct DfrEqualizer {
    std::optional<double> frameRate; // Hz
    std::optional<double> damping;
    std::optional<double> minimum; // least zoom, relative to that of the compound
    SourcePosition at;
    friend bool operator==(const DfrEqualizer&, const DfrEqualizer&) = default;
};

struct FramerateEqualizer {
    SourcePosition at;
    friend bool operator==(const FramerateEqualizer&, const FramerateEqualizer&) = default;
};

struct MonitorEqualizer {
    SourcePosition at;
    friend bool operator==(const MonitorEqualizer&, const MonitorEqualizer&) = default;
};

struct ViewEqualizer {
    SourcePosition at;
    friend bool operator==(const ViewEqualizer&, const ViewEqualizer&) = default;
};

struct TileEqualizer {
    std::optional<std::string> name;
    PixelsOrRange size;
    SourcePosition at;
    friend bool operator==(const TileEqualizer&, const TileEqualizer&) = default;
};

using Equalizer = std::variant<LoadEqualizer, TreeEqualizer, DfrEqualizer, FramerateEqualizer, MonitorEqualizer,
                               ViewEqualizer, TileEqualizer>;

// One step of the path to a destination channel: canvas, segment, layout or view.
enum class PathStep : uint8_t { Canvas, Segment, Layout, View };

struct ChannelPath {
    std::vector<std::pair<PathStep, Reference>> steps; // ordered
    friend bool operator==(const ChannelPath&, const ChannelPath&) = default;
};

// A channel of a window by name, or the destination channel of a view on a segment.
using ChannelReference = std::variant<std::string, ChannelPath>;

struct CompoundAttributes {
    Attribute stereoMode;
    std::optional<ColorMask> anaglyphLeftMask, anaglyphRightMask;
    friend bool operator==(const CompoundAttributes&, const CompoundAttributes&) = default;
};

struct Compound {
    std::optional<std::string> name;
    std::optional<ChannelReference> channel;
    std::optional<TaskSet> tasks; // an empty set: no tasks
    std::optional<EyeSet> eyes;
    std::optional<BufferSet> buffers;
    std::optional<Viewport> viewport;
    std::optional<Range> range;
    std::optional<uint32_t> period, phase;
    std::optional<Zoom> zoom;
    std::optional<PixelKernel> pixel;
    std::optional<SubPixel> subPixel;
    // composition strategy of the channels that draw its ranges, by name, or "auto"
    std::optional<std::string> composition;
    std::optional<ProjectionSurface> surface;
    CompoundAttributes attributes;
    std::vector<Equalizer> equalizers;
    std::optional<SwapBarrier> swapBarrier;
    std::vector<TileQueue> outputTiles, inputTiles;
    std::vector<Compound> children;
    std::vector<Frame> outputFrames, inputFrames;
    SourcePosition at;
    friend bool operator==(const Compound&, const Compound&);
};
bool operator==(const Compound& a, const Compound& b);

} // namespace mural::config
