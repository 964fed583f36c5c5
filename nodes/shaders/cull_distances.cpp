#include "nodes/shaders/cull_distances.hpp"

#include <algorithm>

namespace mural::shaders {

namespace {

// Shaders with these are unsupported: additional distances would change their meaning.
constexpr const char* kExcluding[] = {"gl_ClipVertex", "gl_CullDistance", "gl_ViewportIndex", "gl_ViewportMask"};

bool maybePatched(const GlslText& t) {
    if (t.es && t.version < 300) return false;
    // Blocks captured by transform feedback must keep their members.
    if (t.usesPrefix("xfb_")) return false;
    return std::none_of(std::begin(kExcluding), std::end(kExcluding), [&](const char* name) { return t.uses(name); });
}

std::string distances(const GlslText& t, bool sized) {
    const std::string p = t.es ? "highp " : "";
    std::string grow = "0.0";
    // Points with a shader-defined size may extend beyond the margin.
    if (sized)
        grow = "(gl_PointSize * 0.5 + 2.0 > muralCullPlanes[1].y ? gl_PointSize * 0.5 + 2.0 - muralCullPlanes[1].y : "
               "0.0) * (gl_Position.w < 0.0 ? -gl_Position.w : gl_Position.w)";
    return p + "vec4 muralP = gl_Position; " + p + "float muralGrow = " + grow +
           "; bool muralOn = muralCullPlanes[1].x != 0.0; "
           "gl_CullDistance[0] = muralOn ? muralP.x - muralCullPlanes[0].x * muralP.w + muralGrow * "
           "muralCullPlanes[1].z : 1.0; "
           "gl_CullDistance[1] = muralOn ? muralCullPlanes[0].y * muralP.w - muralP.x + muralGrow * "
           "muralCullPlanes[1].z : 1.0; "
           "gl_CullDistance[2] = muralOn ? muralP.y - muralCullPlanes[0].z * muralP.w + muralGrow * "
           "muralCullPlanes[1].w : 1.0; "
           "gl_CullDistance[3] = muralOn ? muralCullPlanes[0].w * muralP.w - muralP.y + muralGrow * "
           "muralCullPlanes[1].w : 1.0;";
}

// `out gl_PerVertex { … }`: a redeclared block has only the members that it names.
void addBlockMember(const GlslText& t, TextEdits& edits) {
    const std::string member = t.es ? " highp float gl_CullDistance[4];" : " float gl_CullDistance[4];";
    for (size_t i = 1; i + 1 < t.tokens.size(); ++i) {
        if (t.tokens[i].text == "gl_PerVertex" && t.tokens[i - 1].text == "out" && t.tokens[i + 1].text == "{")
            edits.insert(t.tokens[i + 1].at + 1, member);
    }
}

void addExtension(const GlslText& t, TextEdits& edits) {
    const size_t at = t.extensionsAt();
    const bool builtIn = !t.es && t.version >= 450;
    const bool ends = at > 0 && t.source[at - 1] != '\n';
    if (!builtIn)
        edits.insert(at, std::string(ends ? "\n" : "") + "#extension " +
                             (t.es ? "GL_EXT_clip_cull_distance" : "GL_ARB_cull_distance") + " : enable\n");
}

} // namespace

std::optional<std::vector<std::string>> withCullDistances(const std::vector<std::string>& sources, LastStage stage,
                                                          bool es) {
    VertexCode code;
    code.allowed = maybePatched;
    code.declarations = [](const GlslText& t) {
        return std::string("uniform ") + (t.es ? "highp " : "") + "vec4 muralCullPlanes[2];";
    };
    code.body = distances;
    code.more = [](const GlslText& t, TextEdits& edits) {
        addExtension(t, edits);
        addBlockMember(t, edits);
    };
    return withVertexCode(sources, stage, es, code);
}

} // namespace mural::shaders
