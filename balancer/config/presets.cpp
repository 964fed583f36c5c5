#include "balancer/config/presets.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/tile_grid.hpp"

namespace mural::config {

namespace {

constexpr int64_t kMaxChannels = 4096;

struct Named {
    const char* option;
    int32_t value;
};

// One decomposition and its number of parts.
struct Level {
    enum class Kind { Frames, Ranges, Pixels, Samples } kind;
    int32_t count;
};

// Returns edge i of n, rounded to six decimals: readable, and equal for neighbours.
double edge(int32_t i, int32_t n) { return std::round(1e6 * i / n) / 1e6; }
double between(double from, double to) { return std::round(1e6 * (to - from)) / 1e6; }

class Maker {
public:
    explicit Maker(const Preset& form) : form_(form) {
        for (const Level level : {Level{Level::Kind::Frames, form.frames},
                                  {Level::Kind::Ranges, form.ranges},
                                  {Level::Kind::Pixels, form.pixelColumns * form.pixelRows},
                                  {Level::Kind::Samples, form.samples}}) {
            if (level.count > 1) levels_.push_back(level);
        }
    }

    ConfigFile make() {
        file_.version = kCurrentVersion;
        Config& c = file_.config;
        if (form_.frames > 1) c.latency = static_cast<uint32_t>(form_.frames);
        for (const std::string& host : form_.nodes) {
            Node node;
            node.name = host.empty() ? "local." + std::to_string(c.nodes.size()) : host;
            if (!host.empty()) node.host = host;
            c.nodes.push_back(node);
        }
        c.observers.emplace_back();
        View view;
        view.observer = 0u;
        if (form_.stereo != StereoPreset::None) view.mode = ViewMode::Stereo;
        Layout layout;
        layout.name = "whole";
        layout.views.push_back(view);
        c.layouts.push_back(layout);
        Canvas canvas;
        canvas.name = "wall";
        canvas.layouts.emplace_back(std::string("whole"));
        // a wall with the picture's aspect ratio, 1 m high
        const double half = std::round(5e5 * form_.width / form_.height) / 1e6;
        canvas.surface = Wall{{-half, -.5, -1}, {half, -.5, -1}, {-half, .5, -1}, WallType::Fixed, {}};
        if (form_.columns * form_.rows > 1) canvas.swapBarrier.emplace();
        for (int32_t row = 0; row < form_.rows; ++row) {
            for (int32_t column = 0; column < form_.columns; ++column) addTile(canvas, column, row);
        }
        c.canvases.push_back(canvas);
        for (const Segment& s : canvas.segments) addTree(*s.name, *s.channel);
        return std::move(file_);
    }

private:
    // Adds a window and a pipe per channel, alternating between the machines.
    void addChannel(const std::string& name, PixelViewport size, bool shown, std::vector<Channel> channels) {
        Window window;
        window.name = name;
        window.viewport = Viewport{double(size.x), double(size.y), double(size.w), double(size.h)};
        window.channels = std::move(channels);
        if (!shown) window.attributes.hintDrawable = value::kFbo;
        if (shown && form_.stereo == StereoPreset::Quad) window.attributes.hintStereo = value::kOn;
        Pipe pipe;
        pipe.windows.push_back(window);
        if (form_.nodes.empty()) {
            if (!file_.config.appNode) file_.config.appNode.emplace();
            file_.config.appNode->pipes.push_back(pipe);
        } else {
            file_.config.nodes[nextNode_++ % form_.nodes.size()].pipes.push_back(pipe);
        }
    }

    static Channel channelNamed(const std::string& name, std::optional<Viewport> viewport = {}) {
        Channel channel;
        channel.name = name;
        channel.viewport = viewport;
        return channel;
    }

    void addTile(Canvas& canvas, int32_t column, int32_t row) {
        const std::string name =
            form_.columns * form_.rows == 1 ? "wall" : "tile." + std::to_string(column) + "." + std::to_string(row);
        const PixelViewport pixels =
            tileViewport({form_.columns, form_.rows, 1}, column, row, form_.width, form_.height);
        const double x = edge(column, form_.columns), y = edge(row, form_.rows);
        const Viewport part{x, y, between(x, edge(column + 1, form_.columns)), between(y, edge(row + 1, form_.rows))};
        const auto addSegment = [&](const std::string& channel, std::optional<EyeSet> eyes) {
            Segment s;
            s.name = s.channel = channel;
            s.eyes = eyes;
            if (!part.full()) s.viewport = part;
            canvas.segments.push_back(s);
        };
        if (form_.stereo == StereoPreset::Passive) {
            addChannel(name + ".left", pixels, true, {channelNamed(name + ".left")});
            addChannel(name + ".right", pixels, true, {channelNamed(name + ".right")});
        } else if (form_.stereo == StereoPreset::SideBySide) {
            addChannel(name, pixels, true,
                       {channelNamed(name + ".left", Viewport{0, 0, .5, 1}),
                        channelNamed(name + ".right", Viewport{.5, 0, .5, 1})});
        } else {
            addChannel(name, pixels, true, {channelNamed(name)});
            return addSegment(name, {});
        }
        addSegment(name + ".left", EyeSet{Eye::Cyclop, Eye::Left});
        addSegment(name + ".right", EyeSet{Eye::Cyclop, Eye::Right});
    }

    void addTree(const std::string& segment, const std::string& channel) {
        Compound root;
        root.channel = ChannelPath{{{PathStep::Segment, segment}, {PathStep::Layout, std::string("whole")}}};
        if (form_.ranges > 1) root.buffers = BufferSet{Buffer::Color, Buffer::Depth};
        if (form_.ranges > 1 && !form_.composition.empty()) root.composition = form_.composition;
        if (form_.stereo == StereoPreset::Anaglyph) root.attributes.stereoMode = value::kAnaglyph;
        if (form_.stereo == StereoPreset::Quad) root.attributes.stereoMode = value::kQuad;
        if (!form_.zoom.none()) root.zoom = form_.zoom;
        if (form_.frames > 1) root.equalizers.emplace_back(FramerateEqualizer{});
        divide(root, channel, 0);
        file_.config.compounds.push_back(root);
    }

    // Draws each part on a channel of its own. The first range is drawn on the channel that composites the ranges.
    void divide(Compound& c, const std::string& channel, size_t depth) {
        if (depth == levels_.size()) return form_.tileWidth > 0 ? queueTiles(c, channel) : splitArea(c, channel);
        const Level& level = levels_[depth];
        static constexpr const char* kNames[] = {".frame.", ".range.", ".pixel.", ".sample."};
        for (int32_t i = 0; i < level.count; ++i) {
            Compound part;
            std::string name = channel;
            switch (level.kind) {
            case Level::Kind::Frames:
                part.period = static_cast<uint32_t>(level.count);
                part.phase = static_cast<uint32_t>(i);
                break;
            case Level::Kind::Ranges:
                if (form_.chunks > 0)
                    part.inputTiles.push_back(chunksOf(channel));
                else if (form_.split == SplitPreset::Fixed)
                    part.range = Range{edge(i, level.count), edge(i + 1, level.count)};
                break;
            case Level::Kind::Pixels:
                part.pixel =
                    PixelKernel{i % form_.pixelColumns, i / form_.pixelColumns, form_.pixelColumns, form_.pixelRows};
                break;
            case Level::Kind::Samples: part.subPixel = SubPixel{i, level.count}; break;
            }
            if (i > 0 || level.kind != Level::Kind::Ranges) {
                name += kNames[static_cast<size_t>(level.kind)] + std::to_string(i);
                const std::string frameName = level.kind == Level::Kind::Frames ? channel + ".frame" : name;
                const Frame frame = drawOnNewChannel(part, name, frameName);
                if (level.kind != Level::Kind::Frames || i == 0) c.inputFrames.push_back(frame);
            }
            divide(part, name, depth + 1);
            c.children.push_back(std::move(part));
        }
        if (level.kind != Level::Kind::Ranges) return;
        if (form_.split != SplitPreset::Fixed) return addEqualizer(c, SplitMode::Db);
        if (form_.chunks <= 0) return;
        TileQueue queue = chunksOf(channel);
        queue.size.range = edge(1, form_.chunks);
        c.outputTiles.push_back(queue);
    }

    // Adds a channel, on which the part is drawn. Returns the frame that transfers its picture.
    Frame drawOnNewChannel(Compound& part, const std::string& channel, const std::string& frameName) {
        addChannel(channel, {0, 0, form_.width, form_.height}, false, {channelNamed(channel)});
        part.channel = channel;
        Frame frame;
        frame.name = frameName;
        part.outputFrames.push_back(frame);
        return frame;
    }

    static TileQueue chunksOf(const std::string& channel) {
        TileQueue queue;
        queue.name = channel + ".chunks";
        return queue;
    }

    void addEqualizer(Compound& c, SplitMode mode) const {
        LoadEqualizer load;
        load.mode = mode;
        TreeEqualizer tree;
        tree.mode = mode;
        if (form_.split == SplitPreset::Load)
            c.equalizers.emplace_back(load);
        else
            c.equalizers.emplace_back(tree);
    }

    // The destination's channel draws the first part. Fixed parts are strips.
    void splitArea(Compound& c, const std::string& channel) {
        const int32_t n = form_.takers;
        if (n < 2) return;
        for (int32_t i = 0; i < n; ++i) {
            Compound part;
            if (form_.split == SplitPreset::Fixed)
                part.viewport = Viewport{0, edge(i, n), 1, between(edge(i, n), edge(i + 1, n))};
            if (i > 0) {
                const std::string name = channel + ".part." + std::to_string(i);
                c.inputFrames.push_back(drawOnNewChannel(part, name, name));
            }
            c.children.push_back(std::move(part));
        }
        if (form_.split != SplitPreset::Fixed) addEqualizer(c, SplitMode::TwoD);
    }

    void queueTiles(Compound& c, const std::string& channel) {
        if (form_.takers < 2) return;
        TileQueue queue;
        queue.name = channel + ".queue";
        for (int32_t i = 0; i < form_.takers; ++i) {
            const std::string name = channel + ".taker." + std::to_string(i);
            Compound part;
            part.inputTiles.push_back(queue);
            c.inputFrames.push_back(drawOnNewChannel(part, name, name));
            c.children.push_back(std::move(part));
        }
        queue.size.pixels = Pixels2{static_cast<uint32_t>(form_.tileWidth), static_cast<uint32_t>(form_.tileHeight)};
        c.outputTiles.push_back(queue);
    }

    const Preset& form_;
    std::vector<Level> levels_;
    ConfigFile file_;
    size_t nextNode_ = 0;
};

} // namespace

Result<ConfigFile> shortForm(const Preset& form) {
    int64_t channels = 1;
    for (const Named n : {Named{"tiles", form.columns},
                          {"tiles", form.rows},
                          {"db", form.ranges},
                          {"pixel", form.pixelColumns},
                          {"pixel", form.pixelRows},
                          {"subpixel", form.samples},
                          {"dplex", form.frames},
                          {"local-nodes", form.takers}}) {
        if (n.value < 1)
            return Error{std::string("--") + n.option + " cannot be " + std::to_string(n.value) + "; use 1 or more"};
        channels = std::min(channels * n.value, kMaxChannels + 1);
    }
    if (channels > kMaxChannels)
        return Error{"the options create more than " + std::to_string(kMaxChannels) +
                     " parts of a picture; use smaller numbers"};
    if (form.width < form.columns || form.height < form.rows || form.width > 1 << 20 || form.height > 1 << 20) {
        return Error{"a picture of " + std::to_string(form.width) + "x" + std::to_string(form.height) +
                     " pixels cannot be divided this way; choose another size"};
    }
    for (const std::string& host : form.nodes) {
        if (host.find_first_of("\"\n") != std::string::npos)
            return Error{"\"" + host + "\" is not a host; use names or addresses"};
    }
    return Maker(form).make();
}

} // namespace mural::config
