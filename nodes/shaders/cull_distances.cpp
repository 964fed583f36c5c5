#include "nodes/shaders/cull_distances.hpp"

#include <algorithm>

#include "nodes/shaders/glsl_tokens.hpp"

namespace mural::shaders {

namespace {

// What these mean can't be kept, or would be changed, by more distances.
constexpr const char* kExcluding[] = {"gl_ClipVertex", "gl_CullDistance", "gl_ViewportIndex", "gl_ViewportMask",
                                      "EmitStreamVertex", "muralMain"};

bool maybePatched(const GlslText& t) {
    if (t.es && t.version < 300) return false;
    // Captured blocks must keep their members.
    if (t.usesPrefix("xfb_")) return false;
    return std::none_of(std::begin(kExcluding), std::end(kExcluding), [&](const char* name) { return t.uses(name); });
}

struct MainPlaces {
    std::vector<size_t> at;
    bool byMacro = false;
};

MainPlaces findMain(const GlslText& t) {
    MainPlaces places;
    for (size_t i = 0; i + 1 < t.tokens.size(); ++i) {
        if (t.tokens[i].text != "main") continue;
        if (t.tokens[i].directive) places.byMacro = true;
        else if (t.tokens[i + 1].text == "(") places.at.push_back(t.tokens[i].at);
    }
    return places;
}

std::string distances(const GlslText& t, bool sized) {
    const std::string p = t.es ? "highp " : "";
    std::string grow = "0.0";
    // Points of the shader's own size may reach further than the edges are set off.
    if (sized) grow = "(gl_PointSize * 0.5 + 2.0 > muralCullPlanes[1].y ? gl_PointSize * 0.5 + 2.0 - muralCullPlanes[1].y : 0.0) * (gl_Position.w < 0.0 ? -gl_Position.w : gl_Position.w)";
    return p + "vec4 muralP = gl_Position; " + p + "float muralGrow = " + grow + "; bool muralOn = muralCullPlanes[1].x != 0.0; "
           "gl_CullDistance[0] = muralOn ? muralP.x - muralCullPlanes[0].x * muralP.w + muralGrow * muralCullPlanes[1].z : 1.0; "
           "gl_CullDistance[1] = muralOn ? muralCullPlanes[0].y * muralP.w - muralP.x + muralGrow * muralCullPlanes[1].z : 1.0; "
           "gl_CullDistance[2] = muralOn ? muralP.y - muralCullPlanes[0].z * muralP.w + muralGrow * muralCullPlanes[1].w : 1.0; "
           "gl_CullDistance[3] = muralOn ? muralCullPlanes[0].w * muralP.w - muralP.y + muralGrow * muralCullPlanes[1].w : 1.0;";
}

// `out gl_PerVertex { … }`: a block that is redeclared has only the members that it names.
void addBlockMember(const GlslText& t, TextEdits& edits) {
    const std::string member = t.es ? " highp float gl_CullDistance[4];" : " float gl_CullDistance[4];";
    for (size_t i = 1; i + 1 < t.tokens.size(); ++i) {
        if (t.tokens[i].text == "gl_PerVertex" && t.tokens[i - 1].text == "out" && t.tokens[i + 1].text == "{")
            edits.insert(t.tokens[i + 1].at + 1, member);
    }
}

void addHead(const GlslText& t, LastStage stage, TextEdits& edits) {
    const size_t extensions = t.extensionsAt(), declarations = t.declarationsAt();
    const bool builtIn = !t.es && t.version >= 450;
    const bool ends = extensions > 0 && t.source[extensions - 1] != '\n';
    if (!builtIn) edits.insert(extensions, std::string(ends ? "\n" : "") + "#extension " + (t.es ? "GL_EXT_clip_cull_distance" : "GL_ARB_cull_distance") + " : enable\n");
    std::string head = std::string("uniform ") + (t.es ? "highp " : "") + "vec4 muralCullPlanes[2];";
    if (stage == LastStage::Geometry) head += " void muralEmitVertex();";
    edits.insert(declarations, onItsLine(t, declarations, head));
}

// The text that holds main().
std::string patchMain(const GlslText& t, const MainPlaces& main, LastStage stage, bool sized) {
    TextEdits edits;
    addHead(t, stage, edits);
    addBlockMember(t, edits);
    const std::string body = distances(t, sized);
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

std::optional<std::vector<std::string>> withCullDistances(const std::vector<std::string>& sources, LastStage stage, bool es) {
    std::vector<GlslText> texts;
    for (const std::string& s : sources) texts.push_back(scanGlsl(s, es));
    const auto any = [&](const char* name) { return std::any_of(texts.begin(), texts.end(), [&](const GlslText& t) { return t.uses(name); }); };
    if (!std::all_of(texts.begin(), texts.end(), maybePatched)) return std::nullopt;
    if (!any("gl_Position")) return std::nullopt; // nothing is drawn, or by names that only macros give
    // A block that one text redeclares is redeclared in all; emitting elsewhere can't be followed.
    if (texts.size() > 1 && (any("gl_PerVertex") || stage == LastStage::Geometry)) return std::nullopt;
    std::vector<std::string> out = sources;
    int patched = 0;
    for (size_t i = 0; i < texts.size(); ++i) {
        const MainPlaces main = findMain(texts[i]);
        if (main.byMacro) return std::nullopt;
        if (main.at.empty()) continue;
        out[i] = patchMain(texts[i], main, stage, any("gl_PointSize"));
        ++patched;
    }
    if (patched != 1) return std::nullopt;
    return out;
}

} // namespace mural::shaders
