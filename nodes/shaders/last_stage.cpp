#include "nodes/shaders/last_stage.hpp"

#include <algorithm>

namespace mural::shaders {

namespace {

struct MainPlaces {
    std::vector<size_t> at;
    bool byMacro = false;
};

MainPlaces findMain(const GlslText& t) {
    MainPlaces places;
    for (size_t i = 0; i + 1 < t.tokens.size(); ++i) {
        if (t.tokens[i].text != "main") continue;
        if (t.tokens[i].directive)
            places.byMacro = true;
        else if (t.tokens[i + 1].text == "(")
            places.at.push_back(t.tokens[i].at);
    }
    return places;
}

// Patches the text that contains main().
std::string patchMain(const GlslText& t, const MainPlaces& main, LastStage stage, bool sized, const VertexCode& code) {
    TextEdits edits;
    if (code.more) code.more(t, edits);
    std::string head = code.declarations(t);
    if (stage == LastStage::Geometry) head += " void muralEmitVertex();";
    edits.insert(t.declarationsAt(), onItsLine(t, t.declarationsAt(), head));
    const std::string body = code.body(t, sized);
    if (stage == LastStage::Geometry) {
        for (const GlslToken& token : t.tokens) {
            if (token.text == "EmitVertex") edits.replace(token.at, token.text.size(), "muralEmitVertex");
        }
        edits.insert(t.source.size(), "\nvoid muralEmitVertex() { " + body + " EmitVertex(); }\n");
    } else {
        for (const size_t at : main.at) edits.replace(at, 4, "muralMain");
        edits.insert(t.source.size(), "\nvoid main() { muralMain(); " + body + " }\n");
    }
    return edits.apply(t.source);
}

} // namespace

std::optional<std::vector<std::string>> withVertexCode(const std::vector<std::string>& sources, LastStage stage,
                                                       bool es, const VertexCode& code) {
    std::vector<GlslText> texts;
    for (const std::string& s : sources) texts.push_back(scanGlsl(s, es));
    const auto any = [&](const char* name) {
        return std::any_of(texts.begin(), texts.end(), [&](const GlslText& t) { return t.uses(name); });
    };
    if (!std::all_of(texts.begin(), texts.end(), code.allowed)) return std::nullopt;
    if (any("EmitStreamVertex") || any("muralMain")) return std::nullopt;
    if (!any("gl_Position")) return std::nullopt; // draws nothing, or uses names from macros
    // A block redeclared in one text must be redeclared in all. Vertices emitted by another text cannot be followed.
    if (texts.size() > 1 && (any("gl_PerVertex") || stage == LastStage::Geometry)) return std::nullopt;
    std::vector<std::string> out = sources;
    int patched = 0;
    for (size_t i = 0; i < texts.size(); ++i) {
        const MainPlaces main = findMain(texts[i]);
        if (main.byMacro) return std::nullopt;
        if (main.at.empty()) continue;
        out[i] = patchMain(texts[i], main, stage, any("gl_PointSize"), code);
        ++patched;
    }
    if (patched != 1) return std::nullopt;
    return out;
}

} // namespace mural::shaders
