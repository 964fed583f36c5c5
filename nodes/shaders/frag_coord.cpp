#include "nodes/shaders/frag_coord.hpp"

#include "nodes/shaders/glsl_tokens.hpp"

namespace mural::shaders {

std::optional<std::string> withWindowCoordinates(std::string_view source, bool es) {
    const GlslText text = scanGlsl(source, es);
    const bool upper = text.uses("origin_upper_left");
    const std::string window = std::string("(gl_FragCoord + vec4(muralTileOffset.") + (upper ? "xz" : "xy") + ", 0.0, 0.0))";
    TextEdits edits;
    for (size_t i = 0; i < text.tokens.size(); ++i) {
        const GlslToken& t = text.tokens[i];
        if (t.text != "gl_FragCoord") continue;
        const bool declared = i > 0 && text.tokens[i - 1].text == "vec4"; // layout(…) in vec4 gl_FragCoord;
        if (!declared) edits.replace(t.at, t.text.size(), window);
    }
    if (edits.empty()) return std::nullopt;
    const size_t at = text.declarationsAt();
    edits.insert(at, onItsLine(text, at, std::string("uniform ") + (text.es ? "highp " : "") + "vec4 muralTileOffset;"));
    return edits.apply(source);
}

} // namespace mural::shaders
