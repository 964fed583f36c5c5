// Rewriting of shaders that adds cull distances.
#include <gtest/gtest.h>

#include "nodes/shaders/cull_distances.hpp"

namespace mural::shaders {
namespace {

std::string patched(const std::string& source, LastStage stage = LastStage::Vertex, bool es = false) {
    const auto out = withCullDistances({source}, stage, es);
    return out ? out->front() : "";
}
size_t count(const std::string& text, const std::string& part) {
    size_t n = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

TEST(CullDistances, wrapsMain) {
    const std::string out = patched("#version 330\nin vec4 p;\nvoid main() { gl_Position = p; }\n");
    EXPECT_EQ(out.find("#version 330\n#extension GL_ARB_cull_distance : enable\nuniform vec4 muralCullPlanes[2]; in "
                       "vec4 p;\nvoid muralMain() {"),
              0u)
        << out;
    EXPECT_EQ(count(out, "void main()"), 1u);
    EXPECT_EQ(count(out, "gl_CullDistance["), 4u);
}

TEST(CullDistances, supportsOldAndNewVersions) {
    EXPECT_EQ(patched("void main() { gl_Position = ftransform(); }")
                  .find("#extension GL_ARB_cull_distance : enable\nuniform"),
              0u);
    EXPECT_EQ(count(patched("#version 450\nvoid main() { gl_Position = vec4(1); }"), "#extension"), 0u);
    EXPECT_NE(patched("#version 300 es\nvoid main() { gl_Position = vec4(1); }", LastStage::Vertex, true)
                  .find("#extension GL_EXT_clip_cull_distance"),
              std::string::npos);
    EXPECT_EQ(patched("void main() { gl_Position = vec4(1); }", LastStage::Vertex, true), "")
        << "ES 1.00 has no such extension";
}

TEST(CullDistances, keepsExtensionsOfTheProgramFirst) {
    const std::string out = patched(
        "#version 120\n#extension X : enable\n#ifdef Y\nfloat a;\n#endif\nvoid main() { gl_Position = vec4(1); }");
    EXPECT_LT(out.find("GL_ARB_cull_distance"), out.find("#extension X"));
    EXPECT_LT(out.find("#extension X"), out.find("uniform vec4 muralCullPlanes"));
    EXPECT_LT(out.find("uniform vec4 muralCullPlanes[2];\n#ifdef Y"), out.size());
}

TEST(CullDistances, leavesUnsupportedShadersUnchanged) {
    for (const char* body :
         {"gl_ClipVertex = vec4(1); gl_Position = vec4(1);", "gl_CullDistance[0] = 1.0; gl_Position = vec4(1);",
          "gl_ViewportIndex = 1; gl_Position = vec4(1);", "int a;"})
        EXPECT_EQ(patched(std::string("#version 450\nvoid main() { ") + body + " }"), "") << body;
    EXPECT_EQ(patched("#define main other\nvoid main() { gl_Position = vec4(1); }"), "");
    EXPECT_EQ(patched("#version 450\nlayout(xfb_buffer = 0) out gl_PerVertex { vec4 gl_Position; };\nvoid main() { "
                      "gl_Position = vec4(1); }"),
              "");
    EXPECT_EQ(patched("#version 400\nlayout(points) in; void main() { gl_Position = vec4(1); EmitStreamVertex(0); }",
                      LastStage::Geometry),
              "");
    EXPECT_NE(patched("// gl_ClipVertex\nvoid main() { gl_Position = vec4(1); }"), "");
}

TEST(CullDistances, wrapsAllConditionalMains) {
    const std::string out = patched(
        "#ifdef A\nvoid main() { gl_Position = vec4(1); }\n#else\nvoid main(void) { gl_Position = vec4(2); }\n#endif");
    EXPECT_EQ(count(out, "muralMain"), 3u);
}

TEST(CullDistances, addsTheMemberToARedeclaredBlock) {
    const std::string out =
        patched("#version 410\nout gl_PerVertex { vec4 gl_Position; };\nvoid main() { gl_Position = vec4(1); }");
    EXPECT_NE(out.find("out gl_PerVertex { float gl_CullDistance[4]; vec4 gl_Position; };"), std::string::npos) << out;
    const std::string in =
        patched("#version 410\nlayout(points) in; layout(points, max_vertices = 1) out; in gl_PerVertex { vec4 "
                "gl_Position; } gl_in[];\nvoid main() { gl_Position = vec4(1); EmitVertex(); }",
                LastStage::Geometry);
    EXPECT_NE(in.find("in gl_PerVertex { vec4 gl_Position; } gl_in[]"), std::string::npos) << in;
}

TEST(CullDistances, setsThemForEveryEmittedVertex) {
    const std::string out =
        patched("#version 330\nvoid main() { gl_Position = vec4(1); EmitVertex(); EmitVertex(); EndPrimitive(); }",
                LastStage::Geometry);
    EXPECT_EQ(count(out, "muralEmitVertex()"), 4u);
    EXPECT_EQ(count(out, " EmitVertex(); }"), 1u);
    EXPECT_EQ(count(out, "void main()"), 1u);
}

TEST(CullDistances, extendsPointsSizedByTheShader) {
    EXPECT_EQ(patched("void main() { gl_Position = vec4(1); }").find("gl_PointSize"), std::string::npos);
    EXPECT_NE(patched("void main() { gl_Position = vec4(1); gl_PointSize = 9.0; }").find("gl_PointSize * 0.5"),
              std::string::npos);
}

TEST(CullDistances, changesOnlyTheTextWithMain) {
    const std::string helper = "vec4 help() { return vec4(1); }";
    const auto out =
        withCullDistances({helper, "vec4 help(); void main() { gl_Position = help(); }"}, LastStage::Vertex, false);
    ASSERT_TRUE(out);
    EXPECT_EQ((*out)[0], helper);
    EXPECT_NE((*out)[1].find("muralMain"), std::string::npos);
    EXPECT_FALSE(withCullDistances(
        {"void help() { gl_ClipVertex = vec4(1); }", "void help(); void main() { gl_Position = vec4(1); help(); }"},
        LastStage::Vertex, false));
}

} // namespace
} // namespace mural::shaders
