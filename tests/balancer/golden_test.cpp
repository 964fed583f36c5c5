// Checks every value of the table in the README of the example files.
#include <functional>
#include <set>

#include "balancer/config/resolve.hpp"
#include "balancer/config/eqc/parser.hpp"
#include "balancer/config/eqc/section_fields.hpp"
#include "balancer/config/eqc/value_writer.hpp"
#include "tests/balancer/example_files.hpp"

namespace mural::config {

namespace {

struct Row {
    std::string file, version, resources, destinations, layouts, canvases, compounds, frames, features;
};

std::string trimmed(std::string text) {
    text.erase(0, text.find_first_not_of(' '));
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
}

std::vector<Row> goldenRows() {
    std::vector<Row> rows;
    std::ifstream in(testing::exampleFolder() / "README.md");
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("| ") || line.find(".eqc |") == std::string::npos) continue;
        std::vector<std::string> cells;
        std::stringstream stream(line.substr(1));
        for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(trimmed(cell));
        if (cells.size() >= 9)
            rows.push_back({cells[0], cells[1], cells[2], cells[3], cells[4], cells[5], cells[6], cells[7], cells[8]});
    }
    return rows;
}

std::string joined(const std::vector<size_t>& counts) {
    std::string text;
    for (const size_t n : counts) text += (text.empty() ? "" : "/") + std::to_string(n);
    return text;
}

struct CompoundCounts {
    size_t compounds = 0, depth = 0, outputs = 0, inputs = 0;
    void add(const std::vector<Compound>& all, size_t level) {
        for (const Compound& c : all) {
            ++compounds;
            depth = std::max(depth, level);
            outputs += c.outputFrames.size();
            inputs += c.inputFrames.size();
            add(c.children, level + 1);
        }
    }
};

// The features that a file uses, with the table's names.
class Features {
public:
    explicit Features(const ConfigFile& file) : file_(file) {
        const Config& c = file.config;
        if (c.latency) has("latency=" + std::to_string(*c.latency));
        if (c.appNode) node(*c.appNode);
        for (const Node& n : c.nodes) node(n);
        for (const Connection& one : file.serverConnections) connection(one);
        if (c.observers.size() > 1) has("multi-observer");
        for (const Observer& o : c.observers) {
            if (o.focusDistance || o.focusMode) has("focus");
            if (o.vrpnTracker) has("vrpn");
        }
        for (const Layout& l : c.layouts) {
            for (const View& v : l.views) {
                if (v.mode == ViewMode::Stereo) has("view-STEREO");
                surface(v.surface, "view-frustum");
            }
        }
        for (const Canvas& one : c.canvases) canvas(one);
        for (const Compound& one : c.compounds) compound(one);
    }

    [[nodiscard]] std::string text() const {
        std::string all;
        for (const std::string& f : features_) all += (all.empty() ? "" : ", ") + f;
        return all.empty() ? "-" : all;
    }

private:
    void has(const std::string& feature) { features_.insert(feature); }

    // Returns true if the attribute has this value, in the section or globally.
    [[nodiscard]] bool is(const Attribute& own, const char* global, const std::function<bool(int32_t)>& wanted) const {
        const auto found = file_.globals.find(global);
        const bool all = found != file_.globals.end() && wanted(std::get<int32_t>(found->second));
        return all || (own && wanted(*own));
    }

    void surface(const std::optional<ProjectionSurface>& s, const char* feature) {
        if (!s) return;
        if (*feature != '\0') has(feature);
        const auto* wall = std::get_if<Wall>(&*s);
        if (wall == nullptr)
            has("projection");
        else if (wall->type == WallType::Hmd)
            has("HMD");
    }

    void connection(const Connection& c) {
        if (c.type == ConnectionType::Rsp) has("conn:RSP");
    }

    void node(const Node& n) {
        for (const Connection& c : n.connections) connection(c);
        for (const Pipe& p : n.pipes) {
            if (is(p.attributes.hintThread, "EQ_PIPE_IATTR_HINT_THREAD", [](int32_t v) { return v == value::kOff; }))
                has("nonthreaded");
            for (const Window& w : p.windows) window(w);
        }
    }

    void window(const Window& w) {
        const WindowAttributes& a = w.attributes;
        if (is(a.hintFullscreen, "EQ_WINDOW_IATTR_HINT_FULLSCREEN", [](int32_t v) { return v == value::kOn; }))
            has("fullscreen");
        if (is(a.hintDrawable, "EQ_WINDOW_IATTR_HINT_DRAWABLE", [](int32_t v) { return v == value::kFbo; }))
            has("FBO-drawable");
        if (is(a.planesSamples, "EQ_WINDOW_IATTR_PLANES_SAMPLES", [](int32_t v) { return v > 0; })) has("multisample");
        if (is(a.planesColor, "EQ_WINDOW_IATTR_PLANES_COLOR", [](int32_t v) { return v == value::kRgba16f; }))
            has("RGBA16F");
        if (is(a.planesColor, "EQ_WINDOW_IATTR_PLANES_COLOR", [](int32_t v) { return v == value::kRgba32f; }))
            has("RGBA32F");
        for (const Channel& c : w.channels) {
            if (c.attributes.dumpImage) has("dump_image");
        }
    }

    void barrier(const std::optional<SwapBarrier>& b, const char* feature) {
        if (!b) return;
        has(b->nvGroup || b->nvBarrier ? "NV_swap" : feature);
    }

    void canvas(const Canvas& c) {
        barrier(c.swapBarrier, "canvas/segment-swapbarrier");
        surface(c.surface, "");
        for (const Segment& s : c.segments) {
            if (s.eyes) has("segment-eye");
            barrier(s.swapBarrier, "canvas/segment-swapbarrier");
            surface(s.surface, "segment-frustum");
        }
    }

    void compound(const Compound& c) {
        if (c.tasks) has("task-list");
        if (c.eyes) has("eye");
        if (c.viewport) has("2D-viewport");
        if (c.range) has("DB-range");
        if (c.period) has("DPlex");
        if (c.pixel) has("pixel");
        if (c.subPixel) has("subpixel");
        if (c.surface) has("compound-frustum");
        barrier(c.swapBarrier, "swapbarrier");
        if (c.attributes.stereoMode == value::kAnaglyph) has("stereo:ANAGLYPH");
        for (const Equalizer& e : c.equalizers) {
            const std::string name(std::visit([](const auto& one) { return sectionName(one); }, e));
            const auto* load = std::get_if<LoadEqualizer>(&e);
            has(load != nullptr && load->mode ? name + "." + std::string(wordOf(*load->mode)) : name);
        }
        for (const auto* frames : {&c.outputFrames, &c.inputFrames}) {
            for (const Frame& f : *frames) {
                if (f.type == FrameType::Texture) has("texture-frame");
                if (f.buffers) has("frame-buffer");
                if (f.viewport) has("frame-viewport");
            }
        }
        for (const Compound& child : c.children) compound(child);
    }

    const ConfigFile& file_;
    std::set<std::string> features_;
};

Row found(const ConfigFile& file, const ResolvedConfig& resolved) {
    Row row;
    const Config& c = file.config;
    row.version = numberText(file.version);
    size_t pipes = 0, windows = 0, channels = 0;
    std::vector<Node> nodes = c.nodes;
    nodes.push_back(c.appNode.value_or(Node{})); // exists even if the file omits it
    for (const Node& n : nodes) {
        pipes += n.pipes.size();
        for (const Pipe& p : n.pipes) {
            windows += p.windows.size();
            for (const Window& w : p.windows) channels += w.channels.size();
        }
    }
    row.resources = joined({nodes.size(), pipes, windows, channels});
    size_t destinations = 0, views = 0, segments = 0;
    for (const ResolvedChannel& channel : resolved.channels) destinations += channel.isDestination() ? 1 : 0;
    for (const Layout& l : c.layouts) views += l.views.size();
    for (const Canvas& canvas : c.canvases) segments += canvas.segments.size();
    row.destinations = std::to_string(destinations);
    row.layouts = joined({c.layouts.size(), views});
    row.canvases = joined({c.canvases.size(), segments});
    CompoundCounts counts;
    counts.add(c.compounds, 1);
    row.compounds = std::to_string(counts.compounds) + " (" + std::to_string(counts.depth) + ")";
    row.frames = joined({counts.outputs, counts.inputs});
    row.features = Features(file).text();
    return row;
}

} // namespace

TEST(ExampleFiles, matchTheirTable) {
    const std::vector<Row> rows = goldenRows();
    if (rows.empty()) GTEST_SKIP() << testing::noExamples();
    EXPECT_GE(rows.size(), 58u);
    for (const Row& row : rows) {
        SCOPED_TRACE(row.file);
        Diagnostics diagnostics(row.file);
        const ConfigFile file = readConfigFile((testing::exampleFolder() / row.file).string(), diagnostics);
        const ResolvedConfig resolved = resolve(file, {}, diagnostics);
        EXPECT_EQ(diagnostics.errors(), 0) << diagnostics.firstError();
        const Row now = found(file, resolved);
        EXPECT_EQ(now.version, row.version);
        EXPECT_EQ(now.resources, row.resources);
        EXPECT_EQ(now.destinations, row.destinations);
        EXPECT_EQ(now.layouts, row.layouts);
        EXPECT_EQ(now.canvases, row.canvases);
        EXPECT_EQ(now.compounds, row.compounds);
        EXPECT_EQ(now.frames, row.frames);
        EXPECT_EQ(now.features, row.features);
    }
}

} // namespace mural::config
