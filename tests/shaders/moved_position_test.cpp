// Rewriting of shaders that moves positions, for eyes and samples.
#include "nodes/shaders/moved_position.hpp"

#include <gtest/gtest.h>

namespace mural::shaders {
namespace {

std::string patched(const std::string& source, LastStage stage = LastStage::Vertex, bool es = false) {
    const auto out = withMovedPosition({source}, stage, es);
    return out ? out->front() : "";
}
size_t count(const std::string& text, const std::string& part) {
    size_t n = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

TEST(MovedPosition, wrapsMain) {
    const std::string out = patched("#version 330\nin vec4 p;\nvoid main() { gl_Position = p; }\n");
    EXPECT_EQ(out.find("#version 330\nuniform vec4 muralMove[5]; in vec4 p;\nvoid muralMain() {"), 0u) << out;
    EXPECT_EQ(count(out, "void main() { muralMain();"), 1u);
    EXPECT_EQ(count(out, "#extension"), 0u);
}

TEST(MovedPosition, supportsAllVersions) {
    for (const char* version : {"", "#version 110\n", "#version 120\n", "#version 150\n", "#version 450\n"})
        EXPECT_NE(patched(version + std::string("void main() { gl_Position = vec4(1.0); }")).find("muralMove[0]"),
                  std::string::npos)
            << version;
    for (const char* version : {"", "#version 100\n", "#version 300 es\n", "#version 320 es\n"})
        EXPECT_NE(patched(version + std::string("void main() { gl_Position = vec4(1.0); }"), LastStage::Vertex, true)
                      .find("uniform highp vec4 muralMove[5];"),
                  std::string::npos)
            << version;
}

TEST(MovedPosition, supportsEachPossibleLastStage) {
    const std::string geometry =
        patched("#version 330\nvoid main() { gl_Position = vec4(1); EmitVertex(); EmitVertex(); EndPrimitive(); }",
                LastStage::Geometry);
    EXPECT_EQ(count(geometry, "muralEmitVertex()"), 4u) << geometry;
    EXPECT_EQ(count(geometry, "muralMain"), 0u);
    EXPECT_LT(geometry.find("muralMove[0].xy"), geometry.rfind("EmitVertex(); }"));
    EXPECT_EQ(count(patched("#version 400\nlayout(triangles) in; void main() { gl_Position = vec4(1); }",
                            LastStage::TessEvaluation),
                    "muralMain"),
              2u);
}

TEST(MovedPosition, showsNonPerspectivePositionsEquallyToBothEyes) {
    EXPECT_NE(patched("void main() { gl_Position = vec4(1); }")
                  .find("if (gl_Position.w != 1.0) gl_Position += vec4(dot(muralMove[1], vec4(gl_Position.xyw, 1.0)),"),
              std::string::npos);
}

TEST(MovedPosition, leavesUnsupportedShadersUnchanged) {
    EXPECT_EQ(patched("void main() { int a; }"), "");
    EXPECT_EQ(patched("#define main other\nvoid main() { gl_Position = vec4(1); }"), "");
    EXPECT_EQ(patched("#version 440\nlayout(xfb_buffer = 0, xfb_offset = 0) out gl_PerVertex { vec4 gl_Position; "
                      "};\nvoid main() { gl_Position = vec4(1); }"),
              "")
        << "feedback would get moved positions";
    EXPECT_EQ(patched("#version 400\nlayout(points) in; void main() { gl_Position = vec4(1); EmitStreamVertex(0); }",
                      LastStage::Geometry),
              "");
    EXPECT_EQ(patched("void muralMain() {} void main() { gl_Position = vec4(1); }"), "");
}

TEST(MovedPosition, keepsClipVerticesAndBlocks) {
    EXPECT_NE(patched("void main() { gl_ClipVertex = vec4(1); gl_Position = vec4(1); }"), "")
        << "clip planes are in eye coordinates, which stay";
    const std::string block =
        patched("#version 410\nout gl_PerVertex { vec4 gl_Position; };\nvoid main() { gl_Position = vec4(1); }");
    EXPECT_NE(block.find("out gl_PerVertex { vec4 gl_Position; };"), std::string::npos) << block;
}

TEST(MovedPosition, changesOnlyTheTextWithMain) {
    const std::string helper = "vec4 help() { return vec4(1); }";
    const auto out =
        withMovedPosition({helper, "vec4 help(); void main() { gl_Position = help(); }"}, LastStage::Vertex, false);
    ASSERT_TRUE(out);
    EXPECT_EQ((*out)[0], helper);
    EXPECT_NE((*out)[1].find("muralMain"), std::string::npos);
}

} // namespace
} // namespace mural::shaders
