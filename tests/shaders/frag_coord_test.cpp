// Rewriting of fragment shaders that moves window positions and scales derivatives.
#include <gtest/gtest.h>

#include <regex>

#include "nodes/shaders/frag_coord.hpp"

namespace mural::shaders {
namespace {

// Returns the changed source without the suffixes that distinguish functions of several texts.
std::optional<std::string> placed(std::string_view source, const FragmentReads& reads, bool es) {
    const auto out = shaders::withWindowOffset(source, reads, es);
    if (!out) return out;
    return std::regex_replace(*out, std::regex("(mural[A-Za-z0-9]+)_[0-9a-f]{8}\\("), "$1(");
}

constexpr FragmentReads kCoordinates{.coordinates = true}, kBoth{.coordinates = true, .derivatives = true};

TEST(FragCoord, movesReads) {
    EXPECT_EQ(placed("#version 330\nout vec4 c; void main() { c = gl_FragCoord.xyxy; }", kCoordinates, false),
              "#version 330\nuniform vec4 muralPlace[2]; vec4 muralWindow(vec4 p) { return p + vec4(p.xy * "
              "muralPlace[1].xy + muralPlace[0].xy, 0.0, 0.0); } out vec4 c; "
              "void main() { c = muralWindow(gl_FragCoord).xyxy; }");
    EXPECT_FALSE(placed("void main() { gl_FragColor = vec4(1); } // gl_FragCoord", kBoth, false));
}

TEST(FragCoord, scalesDerivativesToWindowPixels) {
    const std::string_view source =
        "#version 430\nin vec2 v; out vec4 c;\nvoid main() { c = vec4(dFdx(v), 1.0 / dFdy(v.x), fwidthFine(v.y)); }";
    EXPECT_FALSE(placed(source, kCoordinates, false));
    const auto out = placed(source, kBoth, false);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("c = vec4(muraldFdx(v), 1.0 / muraldFdy(v.x), muralfwidthFine(v.y));"), std::string::npos)
        << *out;
    EXPECT_NE(out->find("vec2 muraldFdx(vec2 v) { return dFdx(v) + dFdx(v) * muralPlace[1].z; }"), std::string::npos);
    EXPECT_NE(out->find("float muralfwidthFine(float v) { return fwidthFine(v) + abs(dFdxFine(v)) * muralPlace[1].z + "
                        "abs(dFdyFine(v)) * muralPlace[1].w; }"),
              std::string::npos);
    EXPECT_EQ(out->find("muraldFdxFine("), std::string::npos) << "only what is used";
}

constexpr FragmentReads kGradients{.gradients = true};

TEST(TextureGradients, scalesLookupsToWindowPixels) {
    const auto out = placed("#version 330\nuniform sampler2D a; uniform sampler2DShadow b; in vec3 p; out vec4 "
                            "c;\nvoid main() { c = texture(a, p.xy, 0.5) * texture(b, p); }",
                            kGradients, false);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("c = muralTexture(a, p.xy, 0.5) * muralTexture(b, p);"), std::string::npos) << *out;
    EXPECT_NE(
        out->find("vec4 muralTexture(sampler2D s, vec2 p) { if (muralPlace[1].z == 0.0 && muralPlace[1].w == 0.0) "
                  "return texture(s, p); "
                  "return textureGrad(s, p, dFdx(p) * (1.0 + muralPlace[1].z), dFdy(p) * (1.0 + muralPlace[1].w)); }"),
        std::string::npos)
        << *out;
    EXPECT_NE(out->find("float muralTexture(sampler2DShadow s, vec3 p, float b)"), std::string::npos);
    EXPECT_EQ(out->find("samplerCube"), std::string::npos) << "only what is used";
}

TEST(TextureGradients, enablesAnExtensionForOldLookups) {
    const auto out =
        placed("#version 120\nuniform sampler2D a;\nvoid main() { gl_FragColor = texture2D(a, gl_TexCoord[0].xy); }",
               kGradients, false);
    ASSERT_TRUE(out);
    EXPECT_EQ(out->find("#version 120\n#extension GL_ARB_shader_texture_lod : enable\nuniform vec4 muralPlace[2]; vec4 "
                        "muraltexture2D(sampler2D s, vec2 p)"),
              0u)
        << *out;
    EXPECT_NE(out->find("return texture2DGradARB(s, p,"), std::string::npos);
}

TEST(TextureGradients, leavesUnknownLookupsUnchanged) {
    EXPECT_FALSE(placed("#version 330\nuniform samplerBuffer a; uniform sampler2D b; out vec4 c; void main() { c = "
                        "texelFetch(a, 1) + texture(b, vec2(0)); }",
                        kGradients, false));
    EXPECT_FALSE(placed("#version 330\nuniform sampler2D a; vec4 texture(vec2 p) { return p.xyxy; } void main() { "
                        "gl_FragColor = texture(vec2(0)); }",
                        kGradients, false));
    EXPECT_FALSE(placed("#version 300 es\nuniform sampler2D a; out vec4 c; void main() { c = texture(a, vec2(0)); }",
                        kGradients, true));
    EXPECT_FALSE(
        placed("#version 330\nuniform sampler2D a; out vec4 c; void main() { c = textureLod(a, vec2(0), 0.0); }",
               kGradients, false));
}

TEST(FragCoord, givesEachTextOfAStageItsOwnFunctions) {
    const auto first = shaders::withWindowOffset("vec4 a() { return gl_FragCoord; }", kCoordinates, false);
    const auto second = shaders::withWindowOffset("vec4 b() { return gl_FragCoord; }", kCoordinates, false);
    ASSERT_TRUE(first && second);
    const auto nameIn = [](const std::string& text) { return text.substr(text.find("muralWindow"), 20); };
    EXPECT_NE(nameIn(*first), nameIn(*second));
}

TEST(FragCoord, countsFromTheTopWithAnUpperOrigin) {
    const auto out = placed("#version 150\nlayout(origin_upper_left, pixel_center_integer) in vec4 gl_FragCoord;\nvoid "
                            "main() { gl_FragColor = gl_FragCoord; }",
                            kCoordinates, false);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("in vec4 gl_FragCoord;"), std::string::npos) << "the declaration stays";
    EXPECT_NE(out->find("return p + vec4((p.xy + 0.5) * muralPlace[1].xy + muralPlace[0].xz, 0.0, 0.0);"),
              std::string::npos)
        << *out;
}

TEST(FragCoord, addsAPrecisionForEs) {
    const auto out = placed("#extension GL_OES_standard_derivatives : enable\nprecision mediump float;\nvoid main() { "
                            "gl_FragColor = gl_FragCoord; }",
                            kCoordinates, true);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("enable\nuniform highp vec4 muralPlace[2]; mediump vec4 muralWindow(highp vec4 p) {"),
              std::string::npos)
        << *out;
}

TEST(FragCoord, followsMacros) {
    const auto out =
        placed("#define HERE gl_FragCoord.xy\nvoid main() { gl_FragColor = HERE.xyxy; }", kCoordinates, false);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("#define HERE muralWindow(gl_FragCoord)"), std::string::npos);
    EXPECT_EQ(out->find("uniform vec4 muralPlace[2]; vec4 muralWindow("), 0u) << *out;
}

TEST(FragCoordArb, replacesThePositionWithAVariable) {
    const auto out =
        withWindowOffsetArb("!!ARBfp1.0\n# fragment.position\nOPTION ARB_precision_hint_fastest;\nATTRIB p = "
                            "fragment.position;\nMOV result.color, p;\nADD result.color, p, fragment . position;\nEND",
                            255);
    EXPECT_EQ(out, "!!ARBfp1.0\n# fragment.position\nOPTION ARB_precision_hint_fastest;\n"
                   "TEMP muralPosition; MAD muralPosition.xy, fragment.position, program.env[254], "
                   "program.env[255].xyyy; ADD muralPosition.xy, muralPosition, fragment.position; MOV "
                   "muralPosition.zw, fragment.position; ALIAS p = muralPosition;\n"
                   "MOV result.color, p;\nADD result.color, p, muralPosition;\nEND");
}

TEST(FragCoordArb, leavesProgramsWithoutThePositionUnchanged) {
    EXPECT_FALSE(withWindowOffsetArb("!!ARBfp1.0\nMOV result.color, fragment.color;\nEND", 255));
    EXPECT_FALSE(withWindowOffsetArb(
        "!!ARBfp1.0\nPARAM a[256] = { program.env[0..255] };\nMOV result.color, fragment.position;\nEND", 255));
    EXPECT_FALSE(withWindowOffsetArb("", 255));
    EXPECT_FALSE(withWindowOffsetArb("!!ARBfp1.0", 255));
    EXPECT_FALSE(withWindowOffsetArb("nothing of the kind: fragment.position", 255));
}

TEST(FragCoordArb, countsFromTheTopWithAnUpperOrigin) {
    const auto out = withWindowOffsetArb(
        "!!ARBfp1.0\nOPTION ARB_fragment_coord_origin_upper_left;\nMOV result.color, fragment.position;\nEND", 31);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("program.env[31].xzzz"), std::string::npos);
}

TEST(FragCoordArb, shiftsIntegerCentresByHalfAPixel) {
    const auto out = withWindowOffsetArb(
        "!!ARBfp1.0\nOPTION ARB_fragment_coord_pixel_center_integer;\nMOV result.color, fragment.position;\nEND", 31);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("MAD muralPosition.xy, program.env[30], 0.5, muralPosition;"), std::string::npos);
}

} // namespace
} // namespace mural::shaders
