#include "tools/mural/help/value_kinds.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "balancer/simulation/scenes.hpp"
#include "balancer/simulation/simulator.hpp"
#include "compositor/codecs/registry.hpp"
#include "compositor/strategies/strategy.hpp"
#include "nodes/frame_transfer/plane_codecs.hpp"
#include "nodes/input/input_permission.hpp"
#include "nodes/overlay/overlay_mode.hpp"
#include "tools/mural/run/option_choices.hpp"

namespace mural::cli {

namespace {

using Words = std::vector<std::string>;

template <class E, size_t N> Words namesOf(const Choice<E> (&choices)[N]) {
    Words names;
    std::ranges::transform(choices, std::back_inserter(names), &Choice<E>::name);
    return names;
}

Words inputPermissions() {
    Words names;
    for (const auto& permission : input::kInputPermissions) names.emplace_back(permission.second);
    return names;
}

Words overlayModes() {
    Words names;
    for (const auto& mode : kOverlayModes) names.emplace_back(mode.second);
    return names;
}

Words codecs() {
    Words names{kQuickestCodec, kLossyCodec};
    const compositor::CodecRegistry registry;
    for (const compositor::CodecInfo& codec : registry.known()) names.push_back(codec.name);
    names.emplace_back("jpeg-80"); // one of jpeg-1 to jpeg-100
    return names;
}

Words compositions() {
    Words names{"auto"};
    for (const compositor::Strategy strategy : compositor::kEveryStrategy) names.emplace_back(nameOf(strategy));
    return names;
}

Words balanceStrategies() {
    Words names;
    for (const simulation::Strategy strategy : simulation::kCompared) names.emplace_back(nameOf(strategy));
    return names;
}

Words sceneNames() {
    Words names{"all"};
    for (const simulation::Scene& scene : simulation::scenes()) names.push_back(scene.name);
    return names;
}

struct OptionKind {
    std::string_view command; // empty: every command
    std::string_view option;  // longest name, or the name of the argument
    ValueKind (*kind)();
};

template <ValueSource source> ValueKind plain() { return {source, {}, {}}; }
template <const char* pattern> ValueKind files() { return {ValueSource::File, {}, pattern}; }
ValueKind wordsOnly(Words words) { return {ValueSource::Words, std::move(words), {}}; }

constexpr char kConfigFiles[] = "*.eqc";

// Options whose values need more than the name of the value.
const OptionKind kOptions[] = {
    {"show", "--display",
     [] {
         return wordsOnly({"windows", "none"});
     }},
    {"", "--display", [] { return wordsOnly(namesOf(kDisplayChoices)); }},
    {"", "--culling", [] { return wordsOnly(namesOf(kCullingChoices)); }},
    {"", "--tiling", [] { return wordsOnly(namesOf(kTilingChoices)); }},
    {"", "--local-rendering", [] { return wordsOnly(namesOf(kLocalRenderingChoices)); }},
    {"", "--delta", [] { return wordsOnly(namesOf(kDeltaChoices)); }},
    {"", "--readback", [] { return wordsOnly(namesOf(kReadbackChoices)); }},
    {"", "--gl", [] { return wordsOnly(namesOf(kGlChoices)); }},
    {"", "--gpus",
     [] {
         return wordsOnly({"auto", "first"});
     }},
    {"", "--capture-via", [] { return wordsOnly(namesOf(kEntryChoices)); }},
    {"", "--balance", [] { return wordsOnly(namesOf(kBalanceChoices)); }},
    {"config", "--stereo",
     [] {
         return wordsOnly({"on", "off"});
     }},
    {"", "--stereo", [] { return wordsOnly(namesOf(kStereoChoices)); }},
    {"", "--projection", [] { return wordsOnly(namesOf(kProjectionChoices)); }},
    {"", "--window-input", [] { return wordsOnly(inputPermissions()); }},
    {"", "--overlay", [] { return wordsOnly(overlayModes()); }},
    {"", "--codec", [] { return wordsOnly(codecs()); }},
    {"", "--composition", [] { return wordsOnly(compositions()); }},
    {"run", "--stream",
     [] {
         return wordsOnly({"auto", "tcp"});
     }},
    {"replay", "--stream",
     [] {
         return wordsOnly({"auto", "tcp"});
     }},
    {"", "--launch",
     [] {
         return ValueKind{ValueSource::Command, {"auto", "local", "pmix", "slurm", "ssh"}, {}};
     }},
    {"", "--slurm", plain<ValueSource::Text>},
    {"app-report", "--diff", plain<ValueSource::File>},
    {"netperf", "--stream", plain<ValueSource::Text>},
    {"netperf", "--seal",
     [] {
         return wordsOnly({"auto", "siphash", "aes-256-gcm", "chacha20-poly1305", "none"});
     }},
    {"netperf", "--window", plain<ValueSource::Number>},
    {"netperf", "--secret-file", plain<ValueSource::File>},
    {"simulate", "--cost",
     [] {
         return ValueKind{ValueSource::File, sceneNames(), {}};
     }},
    {"simulate", "--equalizer", [] { return wordsOnly(balanceStrategies()); }},
    {"simulate", "CONFIG", files<kConfigFiles>},
    {"config", "FILE", files<kConfigFiles>},
    {"", "--config", files<kConfigFiles>},
    {"", "--layout", plain<ValueSource::Layout>},
    {"", "--canvas", plain<ValueSource::Canvas>},
    {"", "--interface", plain<ValueSource::Interface>},
    {"ctl", "COMMAND", plain<ValueSource::ControlWords>},
    {"page", "COMMAND",
     [] {
         return ValueKind{ValueSource::Session, {"link", "links", "revoke"}, {}};
     }},
    {"page", "--at", plain<ValueSource::Text>},
    {"page", "--for", plain<ValueSource::Text>},
    {"page", "--name", plain<ValueSource::Text>},
    {"page", "--page-embed", plain<ValueSource::Text>},
    {"page", "--page-host", plain<ValueSource::Text>},
    {"help", "COMMAND", plain<ValueSource::MuralCommand>},
    {"node", "--name", plain<ValueSource::Text>},
    {"show", "--name", plain<ValueSource::Text>},
    {"node", "--as", plain<ValueSource::Text>},
};

struct NamedKind {
    std::string_view value;
    ValueSource source;
};

// Kinds by the name of the value.
constexpr NamedKind kNames[] = {
    {"FILE", ValueSource::File},
    {"FILE.svg", ValueSource::File},
    {"PATH", ValueSource::File},
    {"DIR|VIDEO", ValueSource::File},
    {"DIR", ValueSource::Folder},
    {"H1,H2", ValueSource::Hosts},
    {"[H1,H2]", ValueSource::Hosts},
    {"CMD", ValueSource::Command},
    {"session", ValueSource::Session},
    {"glA,glB*", ValueSource::Text},
    {"FRAMES", ValueSource::Number},
    {"N-M", ValueSource::Number},
    {"1,30,90", ValueSource::Number},
    {"N", ValueSource::Number},
    {"NUMBER", ValueSource::Number},
    {"D", ValueSource::Number},
    {"L", ValueSource::Number},
    {"X", ValueSource::Number},
    {"C", ValueSource::Number},
    {"F", ValueSource::Number},
    {"S", ValueSource::Number},
    {"S,S...", ValueSource::Number},
    {"X,Y", ValueSource::Number},
    {"CxR", ValueSource::Number},
    {"WxH", ValueSource::Number},
    {"Z|XxY", ValueSource::Number},
    {"N|CxR", ValueSource::Number},
    {"INT", ValueSource::Number},
    {"UINT", ValueSource::Number},
    {"FLOAT", ValueSource::Number},
    {"SECONDS", ValueSource::Number},
    {"MS", ValueSource::Number},
    {"SIZE", ValueSource::Number},
    {"RATE", ValueSource::Number},
    {"ADDRESS:PORT", ValueSource::Number},
    {"[ADDRESS]:PORT", ValueSource::Number},
    {"HOST:PORT", ValueSource::Number},
    {"[HOST:]PORT", ValueSource::Number},
    {"NAME=HOST:PORT", ValueSource::Text},
};

} // namespace

std::optional<ValueKind> valueKindOf(const std::string& command, const OptionFacts& option) {
    if (!option.choices.empty()) return ValueKind{ValueSource::Words, option.choices, {}};
    const std::string& name = option.names.back();
    for (const OptionKind& entry : kOptions)
        if (entry.option == name && (entry.command.empty() || entry.command == command)) return entry.kind();
    const auto named = std::ranges::find(kNames, option.value, &NamedKind::value);
    if (named == std::end(kNames)) return std::nullopt;
    return ValueKind{named->source, {}, {}};
}

} // namespace mural::cli
