#include "nodes/shaders/moved_position.hpp"

namespace mural::shaders {

std::optional<std::vector<std::string>> withMovedPosition(const std::vector<std::string>& sources, LastStage stage,
                                                          bool es) {
    VertexCode code;
    code.allowed = [](const GlslText& t) { return !t.usesPrefix("xfb_"); };
    code.declarations = [](const GlslText& t) {
        return std::string("uniform ") + (t.es ? "highp " : "") + "vec4 muralMove[5];";
    };
    code.body = [](const GlslText&, bool) {
        return std::string("if (gl_Position.w != 1.0) gl_Position += vec4(dot(muralMove[1], vec4(gl_Position.xyw, "
                           "1.0)), dot(muralMove[2], vec4(gl_Position.xyw, 1.0)), "
                           "muralMove[4].x * dot(muralMove[3], vec4(gl_Position.xyw, 1.0)), dot(muralMove[3], "
                           "vec4(gl_Position.xyw, 1.0))); "
                           "gl_Position.xy += gl_Position.xy * muralMove[0].xy + muralMove[0].zw * gl_Position.w;");
    };
    return withVertexCode(sources, stage, es, code);
}

} // namespace mural::shaders
