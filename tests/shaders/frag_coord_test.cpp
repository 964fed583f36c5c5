#include <gtest/gtest.h>

#include "nodes/shaders/frag_coord.hpp"

namespace mural::shaders {
namespace {

TEST(FragCoord, ReadsAreMoved) {
    EXPECT_EQ(withWindowCoordinates("#version 330\nout vec4 c; void main() { c = gl_FragCoord.xyxy; }", false),
              "#version 330\nuniform vec4 muralTileOffset; out vec4 c; void main() { c = (gl_FragCoord + vec4(muralTileOffset.xy, 0.0, 0.0)).xyxy; }");
    EXPECT_FALSE(withWindowCoordinates("void main() { gl_FragColor = vec4(1); } // gl_FragCoord", false));
}

TEST(FragCoord, UpperOriginsCountFromAbove) {
    const auto out = withWindowCoordinates("#version 150\nlayout(origin_upper_left, pixel_center_integer) in vec4 gl_FragCoord;\nvoid main() { gl_FragColor = gl_FragCoord; }", false);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("in vec4 gl_FragCoord;"), std::string::npos) << "the declaration stays";
    EXPECT_NE(out->find("= (gl_FragCoord + vec4(muralTileOffset.xz, 0.0, 0.0));"), std::string::npos) << *out;
}

TEST(FragCoord, EsWantsAPrecision) {
    const auto out = withWindowCoordinates("#extension GL_OES_standard_derivatives : enable\nprecision mediump float;\nvoid main() { gl_FragColor = gl_FragCoord; }", true);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("enable\nuniform highp vec4 muralTileOffset; precision"), std::string::npos) << *out;
}

TEST(FragCoord, MacrosAreFollowed) {
    const auto out = withWindowCoordinates("#define HERE gl_FragCoord.xy\nvoid main() { gl_FragColor = HERE.xyxy; }", false);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("#define HERE (gl_FragCoord + vec4"), std::string::npos);
    EXPECT_EQ(out->find("uniform vec4 muralTileOffset;\n#define"), 0u) << *out;
}

TEST(FragCoordArb, ThePositionIsAVariable) {
    const auto out = withWindowCoordinatesArb("!!ARBfp1.0\n# fragment.position\nOPTION ARB_precision_hint_fastest;\nATTRIB p = fragment.position;\nMOV result.color, p;\nADD result.color, p, fragment . position;\nEND", 255);
    EXPECT_EQ(out, "!!ARBfp1.0\n# fragment.position\nOPTION ARB_precision_hint_fastest;\n"
                   "TEMP muralPosition; ADD muralPosition, fragment.position, program.env[255].xyww; ALIAS p = muralPosition;\n"
                   "MOV result.color, p;\nADD result.color, p, muralPosition;\nEND");
}

TEST(FragCoordArb, WhatIsNotReadOrTakenIsLeftAlone) {
    EXPECT_FALSE(withWindowCoordinatesArb("!!ARBfp1.0\nMOV result.color, fragment.color;\nEND", 255));
    EXPECT_FALSE(withWindowCoordinatesArb("!!ARBfp1.0\nPARAM a[256] = { program.env[0..255] };\nMOV result.color, fragment.position;\nEND", 255));
    EXPECT_FALSE(withWindowCoordinatesArb("", 255));
    EXPECT_FALSE(withWindowCoordinatesArb("!!ARBfp1.0", 255));
    EXPECT_FALSE(withWindowCoordinatesArb("nothing of the kind: fragment.position", 255));
}

TEST(FragCoordArb, UpperOriginsCountFromAbove) {
    const auto out = withWindowCoordinatesArb("!!ARBfp1.0\nOPTION ARB_fragment_coord_origin_upper_left;\nMOV result.color, fragment.position;\nEND", 31);
    ASSERT_TRUE(out);
    EXPECT_NE(out->find("program.env[31].xzww"), std::string::npos);
}

} // namespace
} // namespace mural::shaders
