// JSON of the session's configuration: one list of fields per struct serves both directions, so a
// field can't be written under one name and read under another.
#include "nodes/session/session_config.hpp"

#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

#include "common/json/json_text.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

template <class E> struct EnumNames;
template <> struct EnumNames<Tiling> {
    static constexpr std::pair<Tiling, const char*> kAll[] = {
        {Tiling::Exact, "exact"}, {Tiling::Culled, "culled"}, {Tiling::Lean, "lean"}};
};
template <> struct EnumNames<CullingMode> {
    static constexpr std::pair<CullingMode, const char*> kAll[] = {
        {CullingMode::Off, "off"}, {CullingMode::Auto, "auto"}, {CullingMode::Audit, "audit"}};
};
template <> struct EnumNames<Display> {
    static constexpr std::pair<Display, const char*> kAll[] = {
        {Display::None, "none"}, {Display::App, "app"}, {Display::Windows, "windows"}};
};
template <> struct EnumNames<LocalRendering> {
    static constexpr std::pair<LocalRendering, const char*> kAll[] = {{LocalRendering::Off, "off"},
                                                                      {LocalRendering::On, "on"}};
};
template <> struct EnumNames<ProjectionChoice> {
    static constexpr std::pair<ProjectionChoice, const char*> kAll[] = {
        {ProjectionChoice::Auto, "auto"}, {ProjectionChoice::Program, "program"}, {ProjectionChoice::Room, "room"}};
};
template <> struct EnumNames<DeltaMode> {
    static constexpr std::pair<DeltaMode, const char*> kAll[] = {
        {DeltaMode::Auto, "auto"}, {DeltaMode::On, "on"}, {DeltaMode::Off, "off"}};
};
template <> struct EnumNames<balance::Balance> { static constexpr auto& kAll = balance::kBalanceNames; };
template <> struct EnumNames<Readback> {
    static constexpr std::pair<Readback, const char*> kAll[] = {
        {Readback::Auto, "auto"}, {Readback::Direct, "direct"}, {Readback::Buffer, "buffer"}};
};
template <> struct EnumNames<input::InputPermission> { static constexpr auto& kAll = input::kInputPermissions; };
template <> struct EnumNames<OverlayMode> { static constexpr auto& kAll = kOverlayModes; };
template <> struct EnumNames<Eye> {
    static constexpr std::pair<Eye, const char*> kAll[] = {
        {Eye::Cyclop, "cyclop"}, {Eye::Left, "left"}, {Eye::Right, "right"}};
};
template <> struct EnumNames<StereoMode> {
    static constexpr std::pair<StereoMode, const char*> kAll[] = {{StereoMode::Off, "off"},
                                                                  {StereoMode::Anaglyph, "anaglyph"},
                                                                  {StereoMode::SideBySide, "side-by-side"},
                                                                  {StereoMode::TopBottom, "top-bottom"},
                                                                  {StereoMode::Left, "left"},
                                                                  {StereoMode::Right, "right"},
                                                                  {StereoMode::Quad, "quad"}};
};

template <class Config, class Visitor>
requires std::is_same_v<std::remove_const_t<Config>, SessionConfig>
void visitFields(Config& c, Visitor&& visit) {
    visit("session", c.session);
    visit("socketPath", c.socketPath);
    visit("columns", c.columns, 1);
    visit("rows", c.rows, 1);
    visit("chunks", c.chunks, 0);
    visit("balance", c.balance);
    visit("tileWidth", c.tileWidth, 0);
    visit("tileHeight", c.tileHeight, 0);
    visit("localNodes", c.localNodes, 0);
    visit("hosts", c.hosts);
    visit("spareHosts", c.spareHosts);
    visit("movedHosts", c.movedHosts);
    visit("launchCommand", c.launchCommand);
    visit("launchSecret", c.launchSecret);
    visit("startTimeoutMs", c.startTimeoutMs);
    visit("stream", c.stream);
    visit("delta", c.delta);
    visit("cacheBytes", c.cacheBytes, 1 << 20);
    visit("restartNodes", c.restartNodes);
    visit("minNodes", c.minNodes);
    visit("remoteMural", c.remoteMural);
    visit("nodeProgram", c.nodeProgram);
    visit("configFile", c.configFile);
    visit("allLocal", c.allLocal);
    visit("canvas", c.canvas);
    visit("layouts", c.layouts);
    visit("projection", c.projection);
    visit("modelUnit", c.modelUnit);
    visit("stereo", c.passes.stereo);
    visit("kernelWidth", c.passes.kernelWidth, 1);
    visit("kernelHeight", c.passes.kernelHeight, 1);
    visit("samples", c.passes.samples, 1);
    visit("period", c.passes.period, 1);
    visit("ranges", c.passes.ranges, 1);
    visit("zoomX", c.passes.zoom.x);
    visit("zoomY", c.passes.zoom.y);
    visit("composition", c.composition);
    visit("codec", c.codec);
    visit("readback", c.readback);
    visit("eyeBase", c.eyeBase);
    visit("focusDistance", c.focusDistance);
    visit("tiling", c.tiling);
    visit("culling", c.culling);
    visit("display", c.display);
    visit("localRendering", c.localRendering);
    visit("glBackend", c.glBackend);
    visit("gpus", c.gpus);
    visit("latency", c.latency, 0);
    visit("verifyEvery", c.verifyEvery, 0);
    visit("frames", c.frames, 0);
    visit("out", c.out);
    visit("saveFrames", c.saveFrames, 1);
    visit("record", c.record);
    visit("frameTimes", c.frameTimes);
    visit("sends", c.sends);
    visit("width", c.width, 0);
    visit("height", c.height, 0);
    visit("fullScreen", c.fullScreen);
    visit("windowX", c.windowX);
    visit("windowY", c.windowY);
    visit("overlay", c.overlay);
    visit("overlayInFiles", c.overlayInFiles);
    visit("windowInput", c.windowInput);
    visit("placeThreads", c.placeThreads);
    visit("explain", c.explain);
    visit("displayName", c.displayName);
}

template <class Setup, class Visitor>
requires std::is_same_v<std::remove_const_t<Setup>, NodeSetup>
void visitFields(Setup& s, Visitor&& visit) {
    visit("node", s.node, 0);
    visit("nodeCount", s.nodeCount, 1);
    visit("columns", s.columns, 1);
    visit("rows", s.rows, 1);
    visit("regionColumn", s.regionColumn, 0);
    visit("regionRow", s.regionRow, 0);
    visit("regionColumns", s.regionColumns, 1);
    visit("regionRows", s.regionRows, 1);
    visit("hasArea", s.hasArea);
    visit("areaX", s.area.x);
    visit("areaY", s.area.y);
    visit("areaWidth", s.area.w);
    visit("areaHeight", s.area.h);
    visit("areas", s.areas);
    visit("anyMovesZoom", s.anyMovesZoom);
    visit("movesZoom", s.movesZoom);
    visit("sharesMachine", s.sharesMachine);
    visit("screen", s.screen);
    visit("shareStart", s.pass.share.start);
    visit("shareEnd", s.pass.share.end);
    visit("zoomX", s.pass.zoom.x);
    visit("zoomY", s.pass.zoom.y);
    visit("shownX", s.pass.shown.x);
    visit("shownY", s.pass.shown.y);
    visit("eye", s.pass.eye);
    visit("kernelX", s.pass.kernelX, 0);
    visit("kernelY", s.pass.kernelY, 0);
    visit("kernelWidth", s.pass.kernelWidth, 1);
    visit("kernelHeight", s.pass.kernelHeight, 1);
    visit("sample", s.pass.sample, 0);
    visit("samples", s.pass.samples, 1);
    visit("phase", s.pass.phase, 0);
    visit("period", s.pass.period, 1);
    visit("range", s.pass.range, 0);
    visit("ranges", s.pass.ranges, 1);
    visit("answers", s.answers);
    visit("eyeBase", s.eyeBase);
    visit("focusDistance", s.focusDistance);
    visit("tiling", s.tiling);
    visit("culling", s.culling);
    visit("glBackend", s.glBackend);
    visit("gpu", s.gpu);
    visit("gpuTurn", s.gpuTurn, 0);
    visit("gpuTurns", s.gpuTurns, 1);
    visit("sendPictures", s.sendPictures);
    visit("pictureCodec", s.pictureCodec);
    visit("windowPixels", s.windowPixels);
    visit("deepPictures", s.deepPictures);
    visit("transferScaleX", s.transferScale.x);
    visit("transferScaleY", s.transferScale.y);
    visit("readback", s.readback);
    visit("partCodec", s.partCodec);
    visit("wallWindows", s.wallWindows);
    visit("windowTitle", s.windowTitle);
    visit("windowAsOnWall", s.windowAsOnWall);
    visit("fullScreen", s.fullScreen);
    visit("windowX", s.windowX);
    visit("windowY", s.windowY);
    visit("overlay", s.overlay);
    visit("windowInput", s.windowInput);
    visit("wallWidthMm", s.wallWidthMm);
    visit("wallHeightMm", s.wallHeightMm);
    visit("placeThreads", s.placeThreads);
    visit("displayName", s.displayName);
    visit("stream", s.stream);
    visit("streamSecret", s.streamSecret);
    visit("delta", s.delta);
    visit("catchesUp", s.isResyncing);
    visit("skipsFrames", s.skipsFrames);
    visit("recordsSpans", s.recordsSpans);
    visit("incarnation", s.incarnation);
    visit("cacheBytes", s.cacheBytes, 1 << 20);
    visit("collector", s.collector, 0);
    visit("shares", s.ranges);
    visit("composition", s.composition);
    visit("exchangeSecret", s.exchangeSecret);
    visit("exchangeHere", s.exchangeHere);
    visit("swapMembers", s.swapMembers, 0);
    visit("swapRank", s.swapRank, 0);
    visit("swapLeader", s.swapLeader, 0);
    visit("swapHere", s.swapHere);
    visit("build", s.build);
    visit("log", s.log);
}

// Area, edges, and the upper three rows of the matrix; null if there is no screen.
Json valueToJson(const std::optional<ScreenView>& screen) {
    Json numbers = Json::array();
    if (!screen) return numbers;
    for (const double n : {screen->area.x, screen->area.y, screen->area.w, screen->area.h, screen->left, screen->right,
                           screen->bottom, screen->top})
        numbers.push_back(n);
    for (size_t row = 0; row < 3; ++row)
        for (const double n : screen->fromProgram.m[row]) numbers.push_back(n);
    return numbers;
}

template <class T> Json valueToJson(const T& value) {
    if constexpr (std::is_enum_v<T>) {
        for (const auto& [e, name] : EnumNames<T>::kAll)
            if (e == value) return name;
        return nullptr;
    } else {
        return value;
    }
}

// Each reader returns an empty text, or the expected type if the value has another type.
std::string readValue(const Json& j, std::string& into, int64_t) {
    if (!j.is_string()) return "a text";
    into = j.get<std::string>();
    return {};
}

std::string readValue(const Json& j, double& into, int64_t) {
    if (!j.is_number()) return "a number";
    into = j.get<double>();
    return {};
}

std::string readValue(const Json& j, bool& into, int64_t) {
    if (!j.is_boolean()) return "true or false";
    into = j.get<bool>();
    return {};
}

template <class Int>
requires std::is_integral_v<Int> std::string readValue(const Json& j, Int& into, int64_t minimum) {
    const int64_t lowest = std::max<int64_t>(minimum, std::numeric_limits<Int>::min());
    const int64_t highest = std::numeric_limits<Int>::max();
    const std::string wanted = "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
    if (!j.is_number_integer()) return wanted;
    if (j.is_number_unsigned() && j.get<uint64_t>() > static_cast<uint64_t>(highest)) return wanted;
    const auto value = j.get<int64_t>();
    if (value < lowest || value > highest) return wanted;
    into = static_cast<Int>(value);
    return {};
}

template <class E>
requires std::is_enum_v<E> std::string readValue(const Json& j, E& into, int64_t) {
    std::string wanted = "one of";
    for (const auto& [e, name] : EnumNames<E>::kAll) {
        if (j.is_string() && j.get_ref<const std::string&>() == name) {
            into = e;
            return {};
        }
        wanted += std::string(" ") + name;
    }
    return wanted;
}

template <class T> std::string readValue(const Json& j, std::vector<T>& into, int64_t minimum) {
    if (!j.is_array()) return "a list";
    into.clear();
    for (const Json& entry : j) {
        T value{};
        const std::string wanted = readValue(entry, value, minimum);
        if (!wanted.empty()) return "a list, each entry " + wanted;
        into.push_back(std::move(value));
    }
    return {};
}

std::string readValue(const Json& j, std::optional<ScreenView>& into, int64_t minimum) {
    std::vector<double> n;
    const std::string wanted = readValue(j, n, minimum);
    if (!wanted.empty()) return wanted;
    if (n.empty()) return {};
    if (n.size() != 20) return "a list of 20 numbers";
    ScreenView& s = into.emplace();
    s.area = {n[0], n[1], n[2], n[3]};
    s.left = n[4], s.right = n[5], s.bottom = n[6], s.top = n[7];
    for (size_t i = 0; i < 12; ++i) s.fromProgram.m[i / 4][i % 4] = n[8 + i];
    return {};
}

template <class Config> std::string write(const Config& config) {
    Json json = Json::object();
    visitFields(config, [&](const char* name, const auto& value, int64_t = 0) { json[name] = valueToJson(value); });
    // Paths need not be UTF-8; a replaced character is better than an exception.
    return jsonText(json);
}

template <class Config> Result<Config> read(const std::string& line, const std::string& what) {
    Json json = parseJson(line);
    if (!json.is_object()) {
        return Error{what + " is not a JSON object: " + line.substr(0, 60) +
                     "; install the same version of mural on both ends"};
    }
    Config config;
    std::string error;
    visitFields(config, [&](const char* name, auto& value, int64_t minimum = INT64_MIN) {
        const auto found = json.find(name);
        if (found == json.end()) return;
        const std::string wanted = readValue(*found, value, minimum);
        if (!wanted.empty() && error.empty()) error = what + ": field " + name + " must be " + wanted;
        json.erase(found);
    });
    if (!error.empty()) return Error{error};
    if (!json.empty()) {
        return Error{what + ": unknown field " + json.begin().key() +
                     "; install the same version of mural on both ends"};
    }
    return config;
}

} // namespace

const char* nameOf(Display display) {
    for (const auto& [value, name] : EnumNames<Display>::kAll)
        if (value == display) return name;
    return "none";
}

namespace {

bool isPossible(const Zoom& zoom) { return zoom.x > 0 && zoom.x <= kMaxZoom && zoom.y > 0 && zoom.y <= kMaxZoom; }
Error noSuchZoom(const std::string& of) {
    return Error{of + ": its zoom is not above 0, or above " + std::to_string(static_cast<int>(kMaxZoom))};
}

} // namespace

std::string toJson(const SessionConfig& config) { return write(config); }

Result<SessionConfig> sessionConfigFromJson(const std::string& line) {
    auto config = read<SessionConfig>(line, "session configuration");
    if (config && !isPossible(config->passes.zoom)) return noSuchZoom("session configuration");
    return config;
}

std::string toJson(const NodeSetup& setup) { return write(setup); }

Result<NodeSetup> nodeSetupFromJson(const std::string& line) {
    auto setup = read<NodeSetup>(line, "node setup");
    if (!setup) return setup;
    const bool inside = setup->node < setup->nodeCount &&
                        setup->regionColumns <= setup->columns - setup->regionColumn &&
                        setup->regionRows <= setup->rows - setup->regionRow;
    if (!inside) return Error{"node setup: the region lies outside of the tile grid"};
    const RenderPass& p = setup->pass;
    if (p.kernelX >= p.kernelWidth || p.kernelY >= p.kernelHeight || p.sample >= p.samples || p.phase >= p.period ||
        p.range >= p.ranges)
        return Error{"node setup: its pass does not belong to the session"};
    if (!isPossible(p.zoom) || !isPossible(p.shown)) return noSuchZoom("node setup");
    if (!isPossible(setup->transferScale) || setup->transferScale.x > 1 || setup->transferScale.y > 1)
        return Error{"node setup: the transfer scale of its pictures is not above 0, or above 1"};
    return setup;
}

} // namespace mural
