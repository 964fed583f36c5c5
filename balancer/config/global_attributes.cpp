#include "balancer/config/global_attributes.hpp"

#include <algorithm>
#include <array>

#include "balancer/config/eqc/attribute_words.hpp"
#include "balancer/config/eqc/value_reader.hpp"

namespace mural::config {

namespace {

using namespace value;
using Kind = GlobalKind;

constexpr int32_t kStatistics = kFastest;

GlobalValue number(int32_t v) { return v; }
GlobalValue text(const char* v) { return std::string(v); }

const std::vector<GlobalAttribute>& table() {
    static const std::vector<GlobalAttribute> kTable{
        {"EQ_CONNECTION_IATTR_TYPE", Kind::ConnectionType, ConnectionType::Tcp},
        {"EQ_CONNECTION_SATTR_HOSTNAME", Kind::Text, text("")},
        {"EQ_CONNECTION_IATTR_PORT", Kind::Number, number(0)},
        {"EQ_CONNECTION_IATTR_BANDWIDTH", Kind::Number, number(0)},
        {"EQ_CONNECTION_SATTR_FILENAME", Kind::Text, text("default")},
        {"EQ_CONFIG_FATTR_EYE_BASE", Kind::Length, .05},
        {"EQ_CONFIG_IATTR_ROBUSTNESS", Kind::Word, number(kAuto)},
        {"EQ_NODE_SATTR_LAUNCH_COMMAND", Kind::Text, text("ssh -n %h %c --eq-logfile %q%d/%h.%n.log%q")},
        {"EQ_NODE_CATTR_LAUNCH_COMMAND_QUOTE", Kind::Character, '\''},
        {"EQ_NODE_IATTR_LAUNCH_TIMEOUT", Kind::Number, number(60'000)},
        {"EQ_NODE_IATTR_THREAD_MODEL", Kind::Word, {}},
        {"EQ_NODE_IATTR_HINT_AFFINITY", Kind::Affinity, number(kAuto)},
        {"EQ_NODE_IATTR_HINT_STATISTICS", Kind::Statistics, {}},
        {"EQ_PIPE_IATTR_HINT_THREAD", Kind::Word, number(kOn)},
        {"EQ_PIPE_IATTR_HINT_AFFINITY", Kind::Affinity, number(kAuto)},
        {"EQ_WINDOW_IATTR_HINT_CORE_PROFILE", Kind::Word, number(kOff)},
        {"EQ_WINDOW_IATTR_HINT_OPENGL_MAJOR", Kind::Number, number(kAuto)},
        {"EQ_WINDOW_IATTR_HINT_OPENGL_MINOR", Kind::Number, number(kAuto)},
        {"EQ_WINDOW_IATTR_HINT_STEREO", Kind::Word, number(kAuto)},
        {"EQ_WINDOW_IATTR_HINT_DOUBLEBUFFER", Kind::Word, number(kAuto)},
        {"EQ_WINDOW_IATTR_HINT_FULLSCREEN", Kind::Word, number(kOff)},
        {"EQ_WINDOW_IATTR_HINT_DECORATION", Kind::Word, number(kAuto)},
        {"EQ_WINDOW_IATTR_HINT_SWAPSYNC", Kind::Word, {}},
        {"EQ_WINDOW_IATTR_HINT_DRAWABLE", Kind::Word, number(kWindow)},
        {"EQ_WINDOW_IATTR_HINT_STATISTICS", Kind::Statistics, number(kStatistics)},
        {"EQ_WINDOW_IATTR_HINT_SCREENSAVER", Kind::Word, number(kAuto)},
        {"EQ_WINDOW_IATTR_HINT_GRAB_POINTER", Kind::Word, number(kOn)},
        {"EQ_WINDOW_IATTR_HINT_WIDTH", Kind::Number, {}},
        {"EQ_WINDOW_IATTR_HINT_HEIGHT", Kind::Number, {}},
        {"EQ_WINDOW_IATTR_PLANES_COLOR", Kind::Number, number(kAuto)},
        {"EQ_WINDOW_IATTR_PLANES_ALPHA", Kind::Number, {}},
        {"EQ_WINDOW_IATTR_PLANES_DEPTH", Kind::Number, number(kAuto)},
        {"EQ_WINDOW_IATTR_PLANES_STENCIL", Kind::Number, number(kAuto)},
        {"EQ_WINDOW_IATTR_PLANES_ACCUM", Kind::Number, {}},
        {"EQ_WINDOW_IATTR_PLANES_ACCUM_ALPHA", Kind::Number, {}},
        {"EQ_WINDOW_IATTR_PLANES_SAMPLES", Kind::Number, number(kAuto)},
        {"EQ_CHANNEL_IATTR_HINT_STATISTICS", Kind::Statistics, number(kStatistics)},
        {"EQ_CHANNEL_IATTR_HINT_SENDTOKEN", Kind::Word, number(kOff)},
        {"EQ_CHANNEL_SATTR_DUMP_IMAGE", Kind::Text, text("")},
        {"EQ_COMPOUND_IATTR_STEREO_MODE", Kind::Word, {}},
        {"EQ_COMPOUND_IATTR_STEREO_ANAGLYPH_LEFT_MASK", Kind::Mask, ColorMask{ColorComponent::Red}},
        {"EQ_COMPOUND_IATTR_STEREO_ANAGLYPH_RIGHT_MASK", Kind::Mask,
         ColorMask{ColorComponent::Green, ColorComponent::Blue}},
        {"EQ_VIEW_SATTR_DEFLECT_HOST", Kind::Text, text("")},
    };
    return kTable;
}

struct Alias {
    std::string_view old;
    std::string_view today;
};

constexpr auto kAliases = std::to_array<Alias>({
    {"EQ_CONNECTION_IATTR_TCPIP_PORT", "EQ_CONNECTION_IATTR_PORT"},
    {"EQ_CONNECTION_SATTR_PIPE_FILENAME", "EQ_CONNECTION_SATTR_FILENAME"},
    {"EQ_CONNECTION_SATTR_LAUNCH_COMMAND", "EQ_NODE_SATTR_LAUNCH_COMMAND"},
    {"EQ_CONNECTION_CATTR_LAUNCH_COMMAND_QUOTE", "EQ_NODE_CATTR_LAUNCH_COMMAND_QUOTE"},
    {"EQ_CONNECTION_IATTR_LAUNCH_TIMEOUT", "EQ_NODE_IATTR_LAUNCH_TIMEOUT"},
    {"EQ_CHANNEL_SATTR_DUMP_IMAGE_FILE_PREFIX", "EQ_CHANNEL_SATTR_DUMP_IMAGE"},
});

// Maps EQ_WINDOW_IATTR_HINT_STEREO to EQ_WINDOW_HINT_STEREO, the name before 2006.
std::string withoutType(std::string_view name) {
    std::string text(name);
    for (const std::string_view type : {"_IATTR_", "_SATTR_", "_FATTR_", "_CATTR_"}) {
        if (const size_t at = text.find(type); at != std::string::npos) return text.replace(at, type.size(), "_");
    }
    return text;
}

const GlobalAttribute* findBy(const std::function<bool(const GlobalAttribute&)>& match) {
    const auto found = std::find_if(table().begin(), table().end(), match);
    return found == table().end() ? nullptr : &*found;
}

} // namespace

std::span<const GlobalAttribute> globalAttributes() { return table(); }

const GlobalAttribute* findGlobalAttribute(std::string_view name) {
    if (const auto* found = findBy([&](const GlobalAttribute& g) { return g.name == name; })) return found;
    for (const Alias& a : kAliases) {
        if (a.old == name || withoutType(a.old) == name) return findGlobalAttribute(a.today);
    }
    return findBy([&](const GlobalAttribute& g) { return withoutType(g.name) == name; });
}

Globals globalsOfEnvironment(const EnvironmentLookup& lookup, Diagnostics& diagnostics) {
    Globals globals;
    for (const GlobalAttribute& g : table()) {
        const std::string name(g.name);
        const auto value = lookup(name);
        if (!value) continue;
        // Texts are taken verbatim. Other values have the syntax of the file.
        if (g.kind == GlobalKind::Text) {
            globals[name] = *value;
            continue;
        }
        if (g.kind == GlobalKind::Character && value->size() == 1) {
            globals[name] = value->front();
            continue;
        }
        Diagnostics inside("environment variable " + name);
        const TokenList list = tokenize(*value, inside);
        TokenReader tokens(list.tokens, inside);
        const auto read = readGlobalValue(tokens, g);
        if (!tokens.ended()) tokens.fail({}, "there is more than one value", "set one value");
        if (inside.errors() == 0 && read)
            globals[name] = *read;
        else
            diagnostics.warn({}, inside.firstError(), "it is ignored");
    }
    return globals;
}

std::optional<GlobalValue> readGlobalValue(TokenReader& tokens, const GlobalAttribute& g) {
    ValueReader reader(tokens, g.name);
    const auto read = [&](auto value) -> std::optional<GlobalValue> {
        reader.read(value);
        if (tokens.failed()) return std::nullopt;
        return GlobalValue(value);
    };
    switch (g.kind) {
    case GlobalKind::Length: return read(double{});
    case GlobalKind::Text: return read(std::string{});
    case GlobalKind::Character: return read(char{});
    case GlobalKind::Mask: return read(ColorMask{});
    case GlobalKind::ConnectionType: return read(ConnectionType{});
    default: break;
    }
    int32_t value = 0;
    reader.readAttribute(value);
    if (tokens.failed()) return std::nullopt;
    return GlobalValue(value);
}

const GlobalValue* GlobalDefaults::find(std::string_view name) const {
    for (const Globals* globals : {&written_, &environment_}) {
        const auto found = globals->find(std::string(name));
        if (found != globals->end()) return &found->second;
    }
    const auto* attribute = findBy([&](const GlobalAttribute& g) { return g.name == name; });
    return attribute != nullptr && attribute->builtIn ? &*attribute->builtIn : nullptr;
}

} // namespace mural::config
