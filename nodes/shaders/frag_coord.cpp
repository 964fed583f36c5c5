#include "nodes/shaders/frag_coord.hpp"

#include <algorithm>
#include <cstdint>
#include <set>

#include "nodes/shaders/glsl_tokens.hpp"
#include "nodes/shaders/texture_gradients.hpp"

namespace mural::shaders {

namespace {

// A stage may consist of several texts with functions of their own, so added names need a unique suffix.
std::string endingOf(std::string_view source) {
    uint32_t sum = 2166136261; // FNV-1a
    for (const char c : source) sum = (sum ^ static_cast<unsigned char>(c)) * 16777619;
    constexpr const char* kDigits = "0123456789abcdef";
    std::string ending = "_";
    for (int shift = 28; shift >= 0; shift -= 4) ending += kDigits[sum >> shift & 15];
    return ending;
}

// Returns a function that yields window coordinates. As a function, expressions with its result keep the native
// precision, which is 16 bits for mediump on some drivers. Integer pixel centres are offset by half a pixel in both
// coordinate systems.
std::string windowCoordinate(const GlslText& text, const std::string& ending) {
    const std::string from = text.uses("origin_upper_left") ? "xz" : "xy";
    const std::string counted = text.uses("pixel_center_integer") ? "(p.xy + 0.5)" : "p.xy";
    const std::string made = !text.es ? "vec4" : text.version < 300 ? "mediump vec4" : "highp vec4";
    return " " + made + " muralWindow" + ending + "(" + (text.es ? "highp " : "") + "vec4 p) { return p + vec4(" +
           counted + " * muralPlace[1].xy + muralPlace[0]." + from + ", 0.0, 0.0); }";
}

constexpr std::string_view kDerivatives[] = {"dFdx",       "dFdy",       "fwidth",     "dFdxFine",    "dFdyFine",
                                             "fwidthFine", "dFdxCoarse", "dFdyCoarse", "fwidthCoarse"};

// GLSL's derivative is between neighbours in this framebuffer; the division converts it to neighbours in the window.
std::string perPixelOfWindow(const std::string& name) {
    if (name.starts_with("dFd")) return name + "(v) + " + name + "(v) * muralPlace[1]." + (name[3] == 'x' ? "z" : "w");
    const std::string kind = name.substr(std::string_view("fwidth").size());
    return name + "(v) + abs(dFdx" + kind + "(v)) * muralPlace[1].z + abs(dFdy" + kind + "(v)) * muralPlace[1].w";
}

std::string functionsFor(const std::string& name, const GlslText& text, const std::string& ending) {
    const std::string precision = !text.es ? "" : text.uses("mediump") ? "mediump " : "highp ";
    std::string functions;
    for (const char* type : {"float", "vec2", "vec3", "vec4"}) {
        const std::string of = precision + type;
        functions += " " + of + " mural" + name + ending + "(" + of + " v) { return " + perPixelOfWindow(name) + "; }";
    }
    return functions;
}

} // namespace

std::optional<std::string> withWindowOffset(std::string_view source, const FragmentReads& reads, bool es) {
    const GlslText text = scanGlsl(source, es);
    const std::string ending = endingOf(source);
    TextEdits edits;
    bool placed = false;
    std::set<std::string> used; // derivatives
    for (size_t i = 0; i < text.tokens.size(); ++i) {
        const GlslToken& t = text.tokens[i];
        if (reads.coordinates && t.text == "gl_FragCoord") {
            const bool declared = i > 0 && text.tokens[i - 1].text == "vec4"; // layout(…) in vec4 gl_FragCoord;
            if (declared) continue;
            edits.replace(t.at, t.text.size(), "muralWindow" + ending + "(gl_FragCoord)");
            placed = true;
        }
        if (!reads.derivatives || std::ranges::find(kDerivatives, t.text) == std::end(kDerivatives)) continue;
        edits.replace(t.at, t.text.size(), "mural" + std::string(t.text) + ending);
        used.emplace(t.text);
    }
    const TextureLookups lookups = reads.gradients ? withWindowGradients(text, ending, edits) : TextureLookups{};
    if (edits.empty()) return std::nullopt;
    std::string declarations = std::string("uniform ") + (text.es ? "highp " : "") + "vec4 muralPlace[2];";
    if (placed) declarations += windowCoordinate(text, ending);
    for (const std::string& name : used) declarations += functionsFor(name, text, ending);
    declarations += lookups.declarations;
    if (!lookups.extension.empty())
        edits.insert(
            text.extensionsAt(),
            (text.extensionsAt() > 0 && source[text.extensionsAt() - 1] != '\n' ? "\n#extension " : "#extension ") +
                lookups.extension + " : enable\n");
    const size_t at = text.declarationsAt();
    edits.insert(at, onItsLine(text, at, declarations));
    return edits.apply(source);
}

} // namespace mural::shaders
