#include "balancer/config/eqc/attribute_words.hpp"

#include <algorithm>

namespace mural::config {

namespace {

using namespace value;

constexpr auto kWords = std::to_array<AttributeWord>({
    {"ON", kOn},
    {"OFF", kOff},
    {"AUTO", kAuto},
    {"NICEST", kNicest},
    {"FASTEST", kFastest},
    {"PASSIVE", kPassive},
    {"ANAGLYPH", kAnaglyph},
    {"anaglyph", kAnaglyph},
    {"QUAD", kQuad},
    {"VERTICAL", kVertical},
    {"HORIZONTAL", kHorizontal},
    {"window", kWindow},
    {"ASYNC", kAsync},
    {"async", kAsync},
    {"DRAW_SYNC", kDrawSync},
    {"draw_sync", kDrawSync},
    {"LOCAL_SYNC", kLocalSync},
    {"local_sync", kLocalSync},
    {"FBO", kFbo},
    {"pbuffer", kFbo},
    {"RGBA16F", kRgba16f},
    {"RGBA32F", kRgba32f},
    {"fixed", kFixed},
    {"relative_to_origin", kRelativeToOrigin},
    {"relative_to_observer", kRelativeToObserver},
    {"CORE", kCore, true},
    {"SOCKET", kSocket, true},
    {"on", kOn, false, true},
    {"off", kOff, false, true},
    {"auto", kAuto, false, true},
    {"nicest", kNicest, false, true},
    {"fastest", kFastest, false, true},
    {"quad", kQuad, false, true},
    {"passive", kPassive, false, true},
    {"core", kCore, true, true},
    {"socket", kSocket, true, true},
    {"fbo", kFbo, false, true},
    {"WINDOW", kWindow, false, true},
});

} // namespace

const AttributeWord* findAttributeWord(std::string_view word) {
    const auto* found =
        std::find_if(kWords.begin(), kWords.end(), [&](const AttributeWord& w) { return w.word == word; });
    return found == kWords.end() ? nullptr : &*found;
}

std::string attributeText(int32_t value, AttributeKind kind) {
    if (value > kOff && value - kCore <= kMaxCores && kind == AttributeKind::Affinity)
        return "CORE " + std::to_string(value - kCore);
    if (value >= kSocket && value - kSocket <= kMaxCores && kind == AttributeKind::Affinity)
        return "SOCKET " + std::to_string(value - kSocket);
    if (value == kFastest && kind == AttributeKind::Statistics) return "FASTEST";
    if (value < 0 || kind != AttributeKind::Number) {
        for (const AttributeWord& w : kWords) {
            if (w.value == value && !w.takesNumber && !w.old) return std::string(w.word);
        }
    }
    return std::to_string(value);
}

} // namespace mural::config
