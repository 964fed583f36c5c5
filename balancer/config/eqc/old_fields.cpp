// Fields of releases since 2005 that today's format expresses in another way. Each is accepted with a warning.
#include "balancer/config/eqc/section_reader.hpp"

#include <algorithm>

#include "balancer/config/eqc/attribute_words.hpp"

namespace mural::config {

namespace {

struct Renamed {
    std::string_view section; // empty: all sections
    std::string_view old;
    std::string_view today;
};

constexpr auto kRenamed = std::to_array<Renamed>({
    {"pipe", "display", "port"},
    {"pipe", "screen", "device"},
    {"connection", "TCPIP_port", "port"},
    {"connection", "PIPE_filename", "filename"},
    {"connection", "pipe_filename", "filename"},
    {"observer", "eyeBase", "eye_base"},
    {"compound", "buffers", "buffer"},
    {"outputframe", "buffers", "buffer"},
    {"inputframe", "buffers", "buffer"},
});

// Fields without effect today.
constexpr auto kGone = std::to_array<std::string_view>(
    {"hint_cuda_GL_interop", "hint_offset", "update_FOV", "format", "displaycluster", "drawable"});

} // namespace

std::string_view SectionReader::todaysWord(std::string_view section, std::string_view word) {
    for (const Renamed& r : kRenamed) {
        if (r.section == section && r.old == word) return r.today;
    }
    return {};
}

void SectionReader::skipUnknown(std::string_view name, const Token& token) {
    const std::string word(token.text);
    const bool gone = std::find(kGone.begin(), kGone.end(), token.text) != kGone.end();
    if (gone)
        tokens_.warn(token.at, word + " has no effect since a newer version of the format", "remove it");
    else
        tokens_.warn(token.at, "section " + std::string(name) + " has no field " + word + ", it is ignored",
                     "check its spelling, or remove it");
    if (tokens_.peek().kind == TokenKind::Word && isAttributeWord(tokens_.peek().text)) {
        int32_t ignored = 0;
        ValueReader(tokens_, token.text).readAttribute(ignored);
    } else {
        tokens_.skipValue();
    }
}

// hints { stereo ON } of 2005 is hint_stereo ON.
void SectionReader::readPrefixed(std::string_view name, std::string_view prefix, WindowAttributes& attributes) {
    tokens_.warn(tokens_.peek().at, "section " + std::string(name) + " is now part of attributes",
                 "write " + std::string(prefix) + "... there");
    if (!tokens_.expect('{', name)) return;
    while (!tokens_.ended() && !tokens_.peek().is('}')) {
        const Token& token = tokens_.take();
        const std::string word = (token.text.starts_with(prefix) ? "" : std::string(prefix)) + std::string(token.text);
        if (token.kind != TokenKind::Word)
            return tokens_.fail(token.at, shown(token) + " is not a field of section " + std::string(name),
                                "remove it");
        if (!readNamed(word, attributes)) skipUnknown(name, token);
    }
    tokens_.expect('}', "section " + std::string(name));
}

bool SectionReader::readOldField(const Token& token, WindowAttributes& attributes) {
    if (!tokens_.peek().is('{')) return false;
    if (token.text == "hints")
        readPrefixed("hints", "hint_", attributes);
    else if (token.text == "planes")
        readPrefixed("planes", "planes_", attributes);
    else
        return false;
    return true;
}

bool SectionReader::readOldField(const Token& token, Window& window) { return readOldField(token, window.attributes); }

bool SectionReader::readOldField(const Token& token, Connection&) {
    std::string_view today;
    if (token.text == "command" || token.text == "launch_command")
        today = "launch_command";
    else if (token.text == "command_quote" || token.text == "launch_command_quote")
        today = "launch_command_quote";
    else if (token.text == "timeout" || token.text == "launch_timeout")
        today = "launch_timeout";
    else
        return false;
    tokens_.warn(token.at, std::string(token.text) + " is now an attribute of the node",
                 "write attributes { " + std::string(today) + " ... } in the node");
    return readNamed(today, oldLaunch_);
}

void SectionReader::finish(Node& node) {
    NodeAttributes& own = node.attributes;
    if (!own.launchCommand) own.launchCommand = oldLaunch_.launchCommand;
    if (!own.launchCommandQuote) own.launchCommandQuote = oldLaunch_.launchCommandQuote;
    if (!own.launchTimeout) own.launchTimeout = oldLaunch_.launchTimeout;
    oldLaunch_ = {};
}

void SectionReader::finish(Config& config) {
    if (!oldFocus_.focusDistance && !oldFocus_.focusMode) return;
    if (config.observers.empty()) config.observers.emplace_back();
    for (Observer& o : config.observers) {
        if (!o.focusDistance) o.focusDistance = oldFocus_.focusDistance;
        if (!o.focusMode) o.focusMode = oldFocus_.focusMode;
    }
    oldFocus_ = {};
}

bool SectionReader::readOldField(const Token& token, ConfigAttributes& attributes) {
    if (token.text == "eyeBase") {
        tokens_.warn(token.at, "eyeBase was renamed to eye_base", "rename it");
        return readNamed("eye_base", attributes);
    }
    if (token.text != "focus_distance" && token.text != "focus_mode") return false;
    tokens_.warn(token.at, std::string(token.text) + " is now a field of observers", "write it in each observer");
    return readNamed(token.text, oldFocus_);
}

bool SectionReader::readOldField(const Token& token, Config& config) {
    ConfigAttributes& a = config.attributes;
    if (token.text != "eyeBase" && token.text != "eye_base") return false;
    tokens_.warn(token.at, std::string(token.text) + " is now an attribute of the configuration",
                 "write attributes { eye_base ... }");
    return readNamed("eye_base", a);
}

bool SectionReader::readOldField(const Token& token, Compound& compound) {
    if (token.text != "loadBalancer" && token.text != "loadbalancer") return false;
    readLoadBalancer(token.at, compound.equalizers);
    return true;
}

namespace {

// loadBalancer of releases until 2015: its mode selects one of today's equalizers.
struct LoadBalancer {
    std::string mode = "2D";
    std::optional<double> damping, frameRate, assembleOnlyLimit;
    PixelsOrRange boundary, resistance;
};

void fields(auto& walk, LoadBalancer& b) {
    walk.value("damping", b.damping);
    walk.value("framerate", b.frameRate);
    walk.value("assemble_only_limit", b.assembleOnlyLimit);
    walk.value("boundary", b.boundary);
    walk.value("resistance", b.resistance);
}

std::optional<Equalizer> todaysEqualizer(const LoadBalancer& b, SourcePosition at) {
    for (const auto& s : spellings(SplitMode{})) {
        if (s.word == b.mode)
            return LoadEqualizer{s.value, b.damping, b.assembleOnlyLimit, b.boundary, b.resistance, at};
    }
    if (b.mode == "DPLEX" || b.mode == "DPlex") return FramerateEqualizer{at};
    if (b.mode == "DFR") return DfrEqualizer{b.frameRate, b.damping, {}, at};
    if (b.mode == "MONITOR" || b.mode == "DDS") return MonitorEqualizer{at};
    return std::nullopt;
}

} // namespace

void SectionReader::readLoadBalancer(SourcePosition at, std::vector<Equalizer>& targets) {
    LoadBalancer balancer;
    if (!tokens_.expect('{', "loadBalancer")) return;
    while (!tokens_.ended() && !tokens_.peek().is('}')) {
        const Token& token = tokens_.take();
        if (token.kind != TokenKind::Word)
            return tokens_.fail(token.at, shown(token) + " is not a field of section loadBalancer", "remove it");
        if (token.text == "mode")
            balancer.mode = tokens_.take().text;
        else if (!readNamed(token.text, balancer))
            skipUnknown("loadBalancer", token);
    }
    if (!tokens_.expect('}', "section loadBalancer")) return;
    auto equalizer = todaysEqualizer(balancer, at);
    if (!equalizer)
        return tokens_.fail(at, "loadBalancer has no mode " + balancer.mode,
                            "use 2D, DB, HORIZONTAL, VERTICAL, DPLEX, DFR or MONITOR");
    const std::string today(std::visit([](const auto& e) { return sectionName(e); }, *equalizer));
    tokens_.warn(at, "loadBalancer was renamed to " + today, "write " + today);
    targets.push_back(std::move(*equalizer));
}

} // namespace mural::config
