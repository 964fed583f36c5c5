#include "tools/mural/run/run_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <utility>

#include "balancer/config/presets.hpp"
#include "balancer/config/eqc/parser.hpp"
#include "balancer/config/eqc/writer.hpp"
#include "compositor/strategies/strategy.hpp"
#include "nodes/head/planning/config_plan.hpp"
#include "nodes/head/planning/preset_plan.hpp"
#include "nodes/launch/private_display.hpp"
#include "nodes/frame_transfer/plane_codecs.hpp"
#include "tools/mural/byte_size.hpp"
#include "transport/connection_description.hpp"
#include "transport/rsp/group_description.hpp"

namespace mural::cli {

namespace {

constexpr int kMaxTilesPerSide = 256;
constexpr int kMaxChunks = 4096;
constexpr int kMaxNodes = 1024;
constexpr int kMaxLatency = 64;
constexpr int kMaxRestarts = 1'000'000;
constexpr int kMaxPasses = 256;
constexpr int kMaxKernel = 16; // columns or rows

constexpr const char* kRunFooter = R"(Examples:
  mural run -- glxgears                                  one node, into the program's own window
  mural run --tiles 2x2 --frames 90 --out shots -- glxgears
                                                         90 frames on 4 local nodes, as PNG files
  mural run --tiles 4x2 --nodes wall1,wall2 --display windows --fullscreen -- app
  mural run --size 7680x4320 --out wall.mp4 -- app       the program sees a screen of that size
  mural run --subpixel 4 -- glxgears                     each pixel is the mean of 4 samples, one per node
  mural run --stereo anaglyph --eye-base 1 --focus 40 -- glxgears
  mural run --record app.mural -- app                    GL stream to a file, for mural replay, dump and trim
  mural run --config wall.eqc -- app                     wall, nodes and compounds from a file
  mural run --native --frames 500 -- glxgears            without Mural, for comparison

Exit status: the program's own; 128 + n after signal n; 0 if --frames ended it.
  2    the session could not start: a bad argument, no display, no GL, or a program that
       cannot be captured (setuid, static, other word size)
  126  the program cannot be executed
  127  the program was not found

MURAL_LOG=rsp:debug,output:trace prints diagnostics of these topics; MURAL_LOG=debug prints those of all. Topics and
levels are in docs/reference/logging.md.)";

std::optional<int64_t> wholeNumber(std::string_view text, int64_t lowest, int64_t highest) {
    int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < lowest || value > highest) return {};
    return value;
}

std::optional<std::pair<int, int>> pairOf(std::string_view text, char separator, int lowest, int highest) {
    const auto at = text.find(separator);
    if (at == std::string_view::npos) return {};
    const auto first = wholeNumber(text.substr(0, at), lowest, highest);
    const auto second = wholeNumber(text.substr(at + 1), lowest, highest);
    if (!first || !second) return {};
    return std::pair(static_cast<int>(*first), static_cast<int>(*second));
}

std::vector<std::string> listOf(const std::string& text) {
    std::vector<std::string> parts;
    size_t at = 0;
    while (at <= text.size()) {
        const size_t end = std::min(text.find(',', at), text.size());
        parts.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return parts;
}

Error badValue(std::string_view option, std::string_view value, std::string_view wanted) {
    return Error{fmt::format("{} \"{}\": {}", option, value, wanted)};
}

template <class E> struct Choice {
    const char* name;
    E value;
};

template <class E, size_t N>
Result<void> choose(std::string_view option, const RunArguments::Text& text, const Choice<E> (&choices)[N], E& into) {
    if (!text) return {};
    std::string names;
    for (const auto& choice : choices) {
        if (*text == choice.name) {
            into = choice.value;
            return {};
        }
        names += names.empty() ? "" : ", ";
        names += choice.name;
    }
    return badValue(option, *text, "must be one of " + names);
}

Result<void> readNumber(std::string_view option, const RunArguments::Text& text, int64_t lowest, int64_t highest,
                        int64_t& into) {
    if (!text) return {};
    const auto value = wholeNumber(*text, lowest, highest);
    if (!value && highest >= INT32_MAX)
        return badValue(option, *text, fmt::format("must be a whole number, at least {}", lowest));
    if (!value) return badValue(option, *text, fmt::format("must be a whole number from {} to {}", lowest, highest));
    into = *value;
    return {};
}

Result<void> readChoices(const RunArguments& a, SessionConfig& c) {
    const Choice<Display> displays[] = {{"app", Display::App}, {"windows", Display::Windows}, {"none", Display::None}};
    const Choice<Tiling> tilings[] = {{"exact", Tiling::Exact}, {"culled", Tiling::Culled}, {"lean", Tiling::Lean}};
    const Choice<LocalRendering> localRenderings[] = {{"off", LocalRendering::Off}, {"on", LocalRendering::On}};
    const Choice<DeltaMode> deltaModes[] = {{"auto", DeltaMode::Auto}, {"on", DeltaMode::On}, {"off", DeltaMode::Off}};
    const Choice<Readback> readbacks[] = {
        {"auto", Readback::Auto}, {"direct", Readback::Direct}, {"buffer", Readback::Buffer}};
    const Choice<const char*> backends[] = {{"auto", "auto"}, {"egl", "egl"}, {"osmesa", "osmesa"}, {"glx", "glx"}};
    const char* backend = "auto";
    if (auto r = choose("--display", a.display, displays, c.display); !r) return r;
    if (auto r = choose("--tiling", a.tiling, tilings, c.tiling); !r) return r;
    if (auto r = choose("--local-rendering", a.localRendering, localRenderings, c.localRendering); !r) return r;
    if (auto r = choose("--gl", a.gl, backends, backend); !r) return r;
    if (auto r = choose("--delta", a.delta, deltaModes, c.delta); !r) return r;
    if (auto r = choose("--readback", a.readback, readbacks, c.readback); !r) return r;
    c.glBackend = backend;
    return {};
}

Result<void> readSizes(const RunArguments& a, SessionConfig& c) {
    if (a.tiles) {
        const auto tiles = pairOf(*a.tiles, 'x', 1, kMaxTilesPerSide);
        if (!tiles)
            return badValue("--tiles", *a.tiles,
                            fmt::format("must be COLUMNSxROWS, each from 1 to {}, such as 2x2", kMaxTilesPerSide));
        std::tie(c.columns, c.rows) = *tiles;
    }
    if (a.tileQueue) {
        const auto tile = pairOf(*a.tileQueue, 'x', 1, launch::kMaxScreenSize);
        if (!tile)
            return badValue("--tile-queue", *a.tileQueue,
                            fmt::format("must be WIDTHxHEIGHT of a tile in pixels, each from 1 to {}, such as 64x64",
                                        launch::kMaxScreenSize));
        if (a.tiles) return Error{"--tiles and --tile-queue both set the tiles; omit one of them"};
        std::tie(c.tileWidth, c.tileHeight) = *tile;
    }
    if (a.size) {
        const auto size = pairOf(*a.size, 'x', 1, launch::kMaxScreenSize);
        if (!size)
            return badValue("--size", *a.size,
                            fmt::format("must be WIDTHxHEIGHT in pixels, each from 1 to {}, such as 7680x4320",
                                        launch::kMaxScreenSize));
        std::tie(c.width, c.height) = *size;
    }
    if (a.position) {
        const auto position = pairOf(*a.position, ',', -launch::kMaxScreenSize, launch::kMaxScreenSize);
        if (!position) return badValue("--position", *a.position, "must be X,Y in pixels, such as 0,0");
        std::tie(c.windowX, c.windowY) = *position;
    }
    return {};
}

// Returns the grid for nodes without --tiles: as square as possible, wider than high.
std::pair<int, int> gridFor(int nodes) {
    int rows = 1;
    for (int r = 1; r * r <= nodes; ++r) {
        if (nodes % r == 0) rows = r;
    }
    return {nodes / rows, rows};
}

Result<void> checkStream(const std::string& stream) {
    if (stream == "auto" || stream == "tcp") return {};
    auto parsed = parseConnectionDescription(stream);
    if (!parsed || parsed->kind != ConnectionDescription::Kind::Rsp)
        return badValue("--stream", stream,
                        "must be auto, tcp, or a multicast group such as rsp://239.255.77.1:4277?rate=800mbit");
    auto options = rsp::groupOptionsOf(*parsed);
    if (!options) return Error{"--stream: " + options.error().message};
    return {};
}

Result<void> readNodes(const RunArguments& a, SessionConfig& c) {
    int64_t local = 0;
    if (auto r = readNumber("--local-nodes", a.localNodes, 1, kMaxNodes, local); !r) return r;
    c.localNodes = static_cast<int>(local);
    if (a.nodes) {
        c.hosts = listOf(*a.nodes);
        const bool bad = std::any_of(c.hosts.begin(), c.hosts.end(), [](const std::string& h) {
            return h.empty() || h.front() == '-' || h.find_first_of(" \t\"'") != std::string::npos;
        });
        if (bad) return badValue("--nodes", *a.nodes, "must be host names separated by commas, such as wall1,wall2");
        // Rejects numbers as host names, because connecting to them would only time out.
        const bool counts = std::any_of(c.hosts.begin(), c.hosts.end(), [](const std::string& h) {
            return h.find_first_not_of("0123456789") == std::string::npos;
        });
        if (counts)
            return badValue(
                "--nodes", *a.nodes,
                "must be host names, such as wall1,wall2; --local-nodes sets the number of nodes on this machine");
    }
    const int requested = c.localNodes + static_cast<int>(c.hosts.size());
    const int passes = static_cast<int>(passesOf(c.passes).size()) * c.passes.ranges;
    if (requested > 0 && !a.tiles && !a.tileQueue)
        std::tie(c.columns, c.rows) = gridFor(std::max(1, requested / passes));
    if (!sharesParts(c) && requested > c.columns * c.rows * passes) {
        return Error{
            fmt::format("{} render nodes for {} tiles{}: each node needs a tile; give more --tiles or fewer nodes",
                        requested, c.columns * c.rows, passes > 1 ? fmt::format(" in {} passes", passes) : "")};
    }
    if (a.launch) c.launchCommand = *a.launch;
    if (a.stream) {
        c.stream = *a.stream;
        if (auto r = checkStream(c.stream); !r) return r;
    }
    if (a.cacheSize) {
        const auto size = byteSizeOf(*a.cacheSize);
        if (!size || *size < (1 << 20) || *size > int64_t{1} << 40)
            return badValue("--cache-size", *a.cacheSize, "must be a size from 1MiB to 1024GiB, such as 512MiB");
        c.cacheBytes = *size;
    }
    c.remoteMural = a.remoteMural.value_or("");
    int64_t restarts = c.restartNodes;
    if (auto r = readNumber("--restart-nodes", a.restartNodes, 0, kMaxRestarts, restarts); !r) return r;
    c.restartNodes = static_cast<int>(restarts);
    int64_t minNodes = c.minNodes;
    if (auto r = readNumber("--min-nodes", a.minNodes, 1, kMaxRestarts, minNodes); !r) return r;
    c.minNodes = static_cast<int>(minNodes);
    if (requested > 0 && c.minNodes > requested)
        return badValue("--min-nodes", *a.minNodes, fmt::format("must be at most {}, the number of nodes", requested));
    if (c.minNodes > 0 && c.restartNodes == 0)
        return Error{"--min-nodes needs restarts of late nodes, but --restart-nodes 0 disables them; omit one of them"};
    return {};
}

std::optional<double> realNumber(std::string_view text, double lowest, double highest) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool read = error == std::errc() && end == text.data() + text.size();
    return read && value >= lowest && value <= highest ? std::optional(value) : std::nullopt;
}

Result<void> readReal(std::string_view option, const RunArguments::Text& text, double lowest, double& into) {
    if (!text) return {};
    const auto value = realNumber(*text, lowest, 1e9);
    if (!value)
        return badValue(option, *text,
                        fmt::format("must be a number, at least {}, in the program's units, such as 0.5", lowest));
    into = *value;
    return {};
}

Result<void> readCount(std::string_view option, const RunArguments::Text& text, int highest, int& into) {
    int64_t value = into;
    if (auto r = readNumber(option, text, 1, highest, value); !r) return r;
    into = static_cast<int>(value);
    return {};
}

// Parses Z, or ZX and ZY.
constexpr double kMinZoom = 0.01; // one pixel of a hundred remains
Result<void> readZoom(const RunArguments& a, Zoom& zoom) {
    if (!a.zoom) return {};
    const size_t x = a.zoom->find('x');
    for (const auto& [text, into] :
         {std::pair(a.zoom->substr(0, x), &zoom.x), {a.zoom->substr(x == std::string::npos ? 0 : x + 1), &zoom.y}}) {
        const auto number = realNumber(text, kMinZoom, kMaxZoom);
        if (!number)
            return badValue(
                "--zoom", *a.zoom,
                fmt::format("must be a number from {} to {}, or two, such as 0.5 or 0.5x1", kMinZoom, kMaxZoom));
        *into = *number;
    }
    return {};
}

// Reads the options for frames in several passes.
Result<void> readBalance(const RunArguments& a, SessionConfig& c) {
    using balance::Balance;
    const Choice<Balance> kinds[] = {
        {"auto", Balance::Auto}, {"load", Balance::Load}, {"tree", Balance::Tree}, {"off", Balance::Off}};
    if (auto r = choose("--balance", a.balance, kinds, c.balance); !r) return r;
    if (!a.balance || a.config) return {};
    for (const auto& [option, given] :
         {std::pair("--tile-queue", a.tileQueue.has_value()), std::pair("--chunk-queue", a.chunkQueue.has_value())})
        if (given) return Error{fmt::format("{} and --balance both distribute the work; omit one of them", option)};
    return {};
}

Result<void> readPasses(const RunArguments& a, SessionConfig& c) {
    const Choice<StereoMode> modes[] = {{"off", StereoMode::Off},
                                        {"anaglyph", StereoMode::Anaglyph},
                                        {"side-by-side", StereoMode::SideBySide},
                                        {"top-bottom", StereoMode::TopBottom},
                                        {"left", StereoMode::Left},
                                        {"right", StereoMode::Right},
                                        {"quad", StereoMode::Quad}};
    PassCounts& p = c.passes;
    if (auto r = choose("--stereo", a.stereo, modes, p.stereo); !r) return r;
    if (auto r = readReal("--eye-base", a.eyeBase, 0, c.eyeBase); !r) return r;
    if (auto r = readReal("--focus", a.focus, 1e-9, c.focusDistance); !r) return r;
    if ((a.eyeBase || a.focus) && p.stereo == StereoMode::Off && !a.config)
        return Error{std::string(a.eyeBase ? "--eye-base" : "--focus") +
                     " requires stereo; add --stereo, such as --stereo anaglyph"};
    if (a.pixel) {
        const auto columns = wholeNumber(*a.pixel, 1, kMaxKernel);
        const auto kernel =
            columns ? std::optional(std::pair(static_cast<int>(*columns), 1)) : pairOf(*a.pixel, 'x', 1, kMaxKernel);
        if (!kernel)
            return badValue(
                "--pixel", *a.pixel,
                fmt::format("must be a number of nodes or COLUMNSxROWS, each from 1 to {}, such as 2x2", kMaxKernel));
        std::tie(p.kernelWidth, p.kernelHeight) = *kernel;
    }
    if (auto r = readCount("--subpixel", a.subpixel, kMaxPasses, p.samples); !r) return r;
    if (auto r = readCount("--dplex", a.dplex, kMaxPasses, p.period); !r) return r;
    if (auto r = readCount("--db", a.db, kMaxPasses, p.ranges); !r) return r;
    if (auto r = readZoom(a, p.zoom); !r) return r;
    if (a.chunkQueue) {
        const auto chunks = wholeNumber(*a.chunkQueue, 2, kMaxChunks);
        if (!chunks)
            return badValue("--chunk-queue", *a.chunkQueue,
                            fmt::format("must be a number of chunks from 2 to {}, such as 64", kMaxChunks));
        if (p.ranges == 1 && !a.config)
            return Error{"--chunk-queue requires sort-last nodes; add --db N, such as --db 4"};
        c.chunks = static_cast<int>(*chunks);
    }
    if (auto r = readBalance(a, c); !r) return r;
    if (a.codec) {
        if (auto wanted = wantedCodec(*a.codec); !wanted)
            return badValue("--codec", *a.codec,
                            "must be auto, lossy or the name of a codec; " + wanted.error().message);
        c.codec = *a.codec;
    }
    if (a.composition) {
        std::string names = "auto";
        for (const compositor::Strategy s : compositor::kEveryStrategy) names += std::string(", ") + nameOf(s);
        if (*a.composition != "auto" && !compositor::strategyNamed(*a.composition))
            return badValue("--composition", *a.composition, "must be one of " + names);
        if (p.ranges == 1 && !a.config)
            return Error{"--composition requires sort-last nodes; add --db N, such as --db 4"};
        c.composition = *a.composition;
    }
    const size_t passes = passesOf(p).size() * static_cast<size_t>(p.ranges);
    if (passes > kMaxPasses)
        return Error{
            fmt::format("--stereo, --pixel, --subpixel, --dplex and --db make {} passes together; the maximum is {}",
                        passes, kMaxPasses)};
    if (passes > 1 && c.tiling == Tiling::Lean)
        return Error{"--tiling lean does not support --stereo, --pixel, --subpixel, --dplex and --db; omit it"};
    if (!p.zoom.none() && c.tiling == Tiling::Lean)
        return Error{"--tiling lean does not support --zoom; omit one of them"};
    if (p.period > 1 && !a.latency) c.latency = p.period; // required for overlapping turns
    return {};
}

Result<void> readProjection(const RunArguments& a, SessionConfig& c) {
    const Choice<ProjectionChoice> all[] = {
        {"auto", ProjectionChoice::Auto}, {"program", ProjectionChoice::Program}, {"room", ProjectionChoice::Room}};
    if (auto r = choose("--projection", a.projection, all, c.projection); !r) return r;
    return readReal("--model-unit", a.modelUnit, 1e-9, c.modelUnit);
}

// The file defines wall and nodes; options for them would contradict it.
Result<void> readConfigFile(const RunArguments& a, RunOptions& options) {
    SessionConfig& c = options.config;
    if (!a.config) {
        const std::pair<const char*, bool> ofFiles[] = {{"--all-local", a.allLocal},
                                                        {"--canvas", a.canvas.has_value()},
                                                        {"--layout", !a.layouts.empty()},
                                                        {"--projection", a.projection.has_value()},
                                                        {"--model-unit", a.modelUnit.has_value()}};
        for (const auto& [option, given] : ofFiles)
            if (given) return Error{fmt::format("{} requires a configuration file; add --config FILE", option)};
        return {};
    }
    const std::pair<const char*, bool> contradicting[] = {{"--tiles", a.tiles.has_value()},
                                                          {"--tile-queue", a.tileQueue.has_value()},
                                                          {"--chunk-queue", a.chunkQueue.has_value()},
                                                          {"--nodes", a.nodes.has_value()},
                                                          {"--local-nodes", a.localNodes.has_value()},
                                                          {"--stereo", a.stereo.has_value()},
                                                          {"--pixel", a.pixel.has_value()},
                                                          {"--subpixel", a.subpixel.has_value()},
                                                          {"--dplex", a.dplex.has_value()},
                                                          {"--db", a.db.has_value()},
                                                          {"--zoom", a.zoom.has_value()}};
    for (const auto& [option, given] : contradicting)
        if (given) return Error{fmt::format("{} and --config both divide the work; omit one of them", option)};
    if (c.tiling == Tiling::Lean) return Error{"--tiling lean does not support --config; omit it"};
    const auto loaded = compound::loadConfig(*a.config, compound::processEnvironment);
    for (const config::Diagnostic& d : loaded.diagnostics.all())
        if (d.severity == config::Severity::Warning) options.notices.push_back(loaded.diagnostics.text(d));
    if (!loaded.ok())
        return Error{loaded.diagnostics.firstError() + (loaded.diagnostics.errors() > 1
                                                            ? fmt::format(" (and {} more: mural config check {})",
                                                                          loaded.diagnostics.errors() - 1, *a.config)
                                                            : "")};
    if (auto r = readProjection(a, c); !r) return r;
    const PlanOptions planOptions{"", a.allLocal, a.canvas.value_or(""), a.layouts, c.projection, c.modelUnit};
    auto plan = planOf(loaded, planOptions);
    if (!plan) return plan.error();
    std::error_code failed;
    c.configFile = std::filesystem::absolute(*a.config, failed).string();
    c.allLocal = a.allLocal;
    c.canvas = planOptions.canvas;
    c.layouts = a.layouts;
    if (!a.eyeBase) c.eyeBase = plan->eyeBase.value_or(c.eyeBase);
    if (!a.focus) c.focusDistance = plan->focusDistance.value_or(c.focusDistance);
    const int processes = static_cast<int>(plan->nodes.size());
    if (processes > kMaxNodes)
        return Error{fmt::format("{}: {} render nodes; the maximum is {}", *a.config, processes, kMaxNodes)};
    for (const NodePlan& node : plan->nodes)
        if (node.reach == NodeReach::LaunchCommand) c.hosts.push_back(node.where);
    int turns = 1;
    for (const NodePlan& node : plan->nodes) turns = std::max(turns, node.pass.period);
    if (!a.latency) c.latency = std::max({1, turns, std::min(static_cast<int>(loaded.resolved.latency), kMaxLatency)});
    if (a.size || a.tiles) return {};
    const compound::PixelSize wall = wallSizeOf(loaded, planOptions);
    if (wall.w > launch::kMaxScreenSize || wall.h > launch::kMaxScreenSize || wall.w < 1 || wall.h < 1)
        return Error{fmt::format(
            "{}: its wall has {}x{} pixels, but a screen has at most {} in each direction; set a smaller --size WxH",
            *a.config, wall.w, wall.h, launch::kMaxScreenSize)};
    c.width = wall.w;
    c.height = wall.h;
    return {};
}

// Returns the configuration file equivalent to the options.
Result<std::string> configTextOf(const RunArguments& a, const SessionConfig& c) {
    if (a.config) {
        config::Diagnostics ignored(*a.config);
        return config::writeConfig(config::readConfigFile(*a.config, ignored));
    }
    auto form = presetOf(c);
    if (!form) return Error{"--print-config: " + form.error().message};
    auto file = config::shortForm(*form);
    if (!file) return file.error();
    return config::writeConfig(*file);
}

Result<void> readOutput(const RunArguments& a, SessionConfig& c) {
    if (a.out && a.out->empty()) return badValue("--out", "", "must be a folder or a video file, such as --out shots");
    c.out = a.out.value_or("");
    if (a.record && a.record->empty()) return badValue("--record", "", "must be a file, such as --record app.mural");
    c.record = a.record.value_or("");
    if (!a.save) return {};
    if (!a.out) return Error{"--save requires --out; add a destination, such as --out shots"};
    for (const std::string& part : listOf(*a.save)) {
        const auto frame = wholeNumber(part, 1, INT64_MAX);
        if (!frame)
            return badValue("--save", *a.save,
                            "must be frame numbers, at least 1, separated by commas, such as 1,30,90");
        c.saveFrames.push_back(*frame);
    }
    std::sort(c.saveFrames.begin(), c.saveFrames.end());
    c.saveFrames.erase(std::unique(c.saveFrames.begin(), c.saveFrames.end()), c.saveFrames.end());
    if (c.frames > 0 && c.saveFrames.back() > c.frames)
        return badValue("--save", *a.save,
                        fmt::format("must have no frame after the last one, {} (--frames)", c.frames));
    return {};
}

Result<void> checkTogether(const RunArguments& a, const SessionConfig& c) {
    if ((a.fullScreen || a.position.has_value()) && c.display != Display::Windows) {
        return Error{std::string(a.fullScreen ? "--fullscreen" : "--position") +
                     " requires wall windows; add --display windows"};
    }
    if (a.native && (a.out.has_value() || a.record.has_value() || c.verifyEvery > 0)) {
        return Error{std::string(c.verifyEvery > 0 ? "--verify"
                                 : a.out           ? "--out"
                                                   : "--record") +
                     " requires captured frames; omit --native"};
    }
    if (c.width > 0 && (c.columns > c.width || c.rows > c.height)) {
        return Error{fmt::format("{}x{} tiles do not fit in {}x{} pixels; give fewer tiles", c.columns, c.rows, c.width,
                                 c.height)};
    }
    return {};
}

} // namespace

void describeRunOptions(CLI::App& command, RunArguments& a) {
    command.option_defaults()->take_last();
    command.add_option("--tiles", a.tiles, "tiles of the wall, columns x rows (1x1, or one for each node)")
        ->type_name("CxR");
    command
        .add_option("--tile-queue", a.tileQueue,
                    "tiles of W x H pixels; nodes with less work take more of them (none: each node keeps its tiles)")
        ->type_name("WxH");
    command
        .add_option(
            "--chunk-queue", a.chunkQueue,
            "with --db: draws in N chunks; nodes with less work take more of them (none: nodes have equal ranges)")
        ->type_name("N");
    command
        .add_option("--balance", a.balance,
                    "areas of nodes, or ranges with --db, follow their times: auto (a map of the cost), load or tree "
                    "(equalizers of the file format), off (equal parts; as in the file)")
        ->type_name("KIND");
    command.add_option("--nodes", a.nodes, "render nodes on these hosts, separated by commas")->type_name("H1,H2");
    command.add_option("--local-nodes", a.localNodes, "render nodes on this machine (one per tile, at most 4)")
        ->type_name("N");
    command.add_option("--size", a.size, "size of the wall; the program runs on a private display of this size")
        ->type_name("WxH");
    command.add_option("--frames", a.frames, "end the program after N frames; later frames are not saved")
        ->type_name("N");
    command.add_option("--out", a.out, "write pictures into a folder (PNG), or a video (.mp4, .mkv, .webm, …)")
        ->type_name("DIR|VIDEO");
    command.add_option("--save", a.save, "with --out: write only these frames, counted from 1")->type_name("1,30,90");
    command.add_option("--record", a.record, "record the program's GL stream to this file, for mural replay")
        ->type_name("FILE");
    command.add_option("--config", a.config, "wall, nodes and compounds from a configuration file (.eqc)")
        ->type_name("FILE");
    command.add_option("--canvas", a.canvas, "show only this canvas of the file (all)")->type_name("NAME");
    command
        .add_option("--projection", a.projection,
                    "view of the file's screens: program (all screens form one flat picture), room (each screen as "
                    "seen by the observer), or auto: room if screens stand at angles (auto)")
        ->type_name("WHOSE");
    command.add_option("--model-unit", a.modelUnit, "length of the room's metre in the program's units (1)")
        ->type_name("N");
    command.add_option("--layout", a.layouts, "show this layout of the file's canvases; repeatable, once per canvas")
        ->type_name("NAME")
        ->take_all();
    command.add_flag("--all-local", a.allLocal, "run all nodes of the file on this machine");
    command.add_flag("--print-config", a.printConfig,
                     "print the configuration file that is equivalent to the other options, and run nothing");
    command
        .add_option("--stereo", a.stereo,
                    "render two eyes for a monoscopic program: anaglyph, side-by-side, top-bottom, quad (wall windows "
                    "with a buffer for each eye), or one eye: left, right (off)")
        ->type_name("MODE");
    command.add_option("--eye-base", a.eyeBase, "distance between the eyes, in the program's units (0.05)")
        ->type_name("D");
    command.add_option("--focus", a.focus, "distance at which both eyes converge, in the program's units (1)")
        ->type_name("D");
    command
        .add_option(
            "--subpixel", a.subpixel,
            "antialiasing: each pixel is the mean of N jittered samples; each sample is drawn by its own nodes (1)")
        ->type_name("N");
    command
        .add_option(
            "--zoom", a.zoom,
            "resolution of drawn parts relative to shown parts: below 1 faster and coarser, above 1 smooth edges (1)")
        ->type_name("Z|XxY");
    command
        .add_option("--pixel", a.pixel,
                    "interleaved pixels: each node draws every Nth column (or one pixel of each CxR) with little "
                    "memory; approximate (1)")
        ->type_name("N|CxR");
    command.add_option("--dplex", a.dplex, "time-multiplex: N nodes draw whole frames in turn (1)")->type_name("N");
    command.add_option("--db", a.db, "sort-last: N nodes draw ranges of each frame's draws, composited by depth (1)")
        ->type_name("N");
    command
        .add_option("--composition", a.composition,
                    "sort-last algorithm: serial, direct-send, binary-swap, 2-3-swap, radix-k, streaming, or auto: by "
                    "the number of nodes (auto)")
        ->type_name("HOW");
    command
        .add_option(
            "--codec", a.codec,
            "codec of transferred pictures: auto (the fastest lossless one, for nodes of other machines), lossy (the "
            "fastest of all), or a name: raw, bitplane, bitplane-zstd, lz4, zstd, yuv420, jpeg-1 to jpeg-100 (auto)")
        ->type_name("HOW");
    command
        .add_option("--display", a.display,
                    "output of the wall: app (the program's own window), windows (one per tile), none")
        ->type_name("WHERE");
    command
        .add_option("--tiling", a.tiling,
                    "exact: the pixels of one machine; culled: less work for much geometry, exact in windows with a "
                    "depth buffer; lean: less memory (exact)")
        ->type_name("HOW");
    command
        .add_option("--local-rendering", a.localRendering,
                    "off: the program's own GL draws nothing; on: it draws too (off)")
        ->type_name("WHAT");
    command.add_option("--gl", a.gl, "GL of the render nodes: auto, egl, osmesa, glx (auto)")->type_name("GL");
    command
        .add_option("--capture-via", a.captureVia,
                    "capture of the program's GL: glvnd, preload (also the program's own GL library), auto: by the "
                    "program's libraries (auto)")
        ->type_name("WAY");
    command.add_option("--latency", a.latency, "number of frames that the program may be ahead of the wall (1)")
        ->type_name("N");
    command.add_flag("--verify{1}", a.verify, "compare every frame (=N: every Nth) with the program's own picture");
    command.add_flag("--fullscreen", a.fullScreen, "wall windows without borders, one per monitor");
    command.add_option("--position", a.position, "upper left corner of the wall windows on the screen")
        ->type_name("X,Y");
    command.add_flag("--no-placement", a.noPlacement, "leave thread placement to the kernel");
    command.add_flag("--explain", a.explain, "print the selected decomposition and rewriting, with reasons");
    command.add_flag("--native", a.native, "run without Mural; count frames and time");
    command.add_option("--launch", a.launch, "command that runs a command on a host (ssh -o BatchMode=yes)")
        ->type_name("CMD");
    command
        .add_option("--stream", a.stream,
                    "transport of the stream to other machines: auto (multicast for two or more), tcp, or "
                    "rsp://GROUP:PORT?interface=…&rate=… (auto)")
        ->type_name("HOW");
    command
        .add_option("--readback", a.readback,
                    "readback of pictures: direct (before the next frame), buffer (asynchronous, in another thread), "
                    "auto: the one that costs the drawing thread less (auto)")
        ->type_name("HOW");
    command
        .add_option("--delta", a.delta,
                    "delta coding, which sends data to a node only once: auto (nodes of other machines), on (all "
                    "nodes), off (auto)")
        ->type_name("WHICH");
    command
        .add_option("--cache-size", a.cacheSize,
                    "memory of the delta cache, in the head and in each of those nodes (1GiB)")
        ->type_name("SIZE");
    command.add_option("--restart-nodes", a.restartNodes, "restart a lost node up to N times in a row; 0: never (3)")
        ->type_name("N");
    command.add_option("--min-nodes", a.minNodes, "begin with N nodes; late or failed ones join later (all)")
        ->type_name("N");
    command.add_option("--remote-mural", a.remoteMural, "path of mural on the hosts (the local path)")
        ->type_name("PATH");
    command.add_option("--report", a.report, "write the final report to this file, as one line of JSON")
        ->type_name("FILE");
    command.add_flag("--quiet", a.quiet, "print only errors");
    command.footer(kRunFooter);
}

Result<RunOptions> runOptionsFrom(const RunArguments& a) {
    RunOptions options;
    SessionConfig& c = options.config;
    if (auto r = readChoices(a, c); !r) return r.error();
    if (auto r = readSizes(a, c); !r) return r.error();
    if (auto r = readNumber("--frames", a.frames, 1, INT64_MAX, c.frames); !r) return r.error();
    int64_t latency = c.latency;
    if (auto r = readNumber("--latency", a.latency, 0, kMaxLatency, latency); !r) return r.error();
    c.latency = static_cast<int>(latency);
    if (auto r = readPasses(a, c); !r) return r.error();
    if (auto r = readNodes(a, c); !r) return r.error();
    if (auto r = readConfigFile(a, options); !r) return r.error();
    int64_t verify = 0;
    if (auto r = readNumber("--verify", a.verify.empty() ? RunArguments::Text() : a.verify, 1, INT32_MAX, verify); !r)
        return r.error();
    c.verifyEvery = static_cast<int>(verify);
    if (verify > 0 && (c.passes.stereo != StereoMode::Off || c.passes.samples > 1 || !c.passes.zoom.none()))
        return Error{"--verify compares with the program's own picture, which --stereo, --subpixel and --zoom change; "
                     "omit one of them"};
    if (auto r = readOutput(a, c); !r) return r.error();
    if (auto r = checkTogether(a, c); !r) return r.error();
    c.fullScreen = a.fullScreen;
    c.placeThreads = !a.noPlacement;
    c.explain = a.explain;
    const Choice<EntryChoice> entries[] = {
        {"auto", EntryChoice::Auto}, {"glvnd", EntryChoice::Glvnd}, {"preload", EntryChoice::Preload}};
    if (auto r = choose("--capture-via", a.captureVia, entries, options.captureVia); !r) return r.error();
    options.displayChosen = a.display.has_value();
    options.native = a.native;
    options.quiet = a.quiet;
    if (a.report && a.report->empty()) return badValue("--report", "", "must be a file, such as --report report.json");
    options.reportFile = a.report.value_or("");
    options.program = a.program;
    if (a.printConfig) {
        auto text = configTextOf(a, c);
        if (!text) return text.error();
        options.configText = std::move(*text);
        return options;
    }
    if (options.program.empty())
        return Error{"no program given; add it after --, such as: mural run --tiles 2x2 -- glxgears"};
    return options;
}

} // namespace mural::cli
