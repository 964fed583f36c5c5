// The GLSL scanner: versions, directives, comments, edits.
#include <gtest/gtest.h>

#include "nodes/shaders/glsl_tokens.hpp"

namespace mural::shaders {
namespace {

TEST(GlslTokens, ignoresNamesInComments) {
    const GlslText t =
        scanGlsl("// gl_FragCoord\n/* gl_FragCoord\n*/ float a/**/b; // \\\ngl_FragCoord\nint c;", false);
    EXPECT_FALSE(t.uses("gl_FragCoord"));
    EXPECT_TRUE(t.uses("a"));
    EXPECT_TRUE(t.uses("b"));
    EXPECT_TRUE(t.uses("c"));
}

TEST(GlslTokens, matchesWholeNames) {
    const GlslText t = scanGlsl("my_gl_FragCoord gl_FragCoord2 mainly 1e5f 0x1F", false);
    EXPECT_FALSE(t.uses("gl_FragCoord"));
    EXPECT_FALSE(t.uses("main"));
    EXPECT_TRUE(t.usesPrefix("gl_Frag"));
    EXPECT_TRUE(t.uses("0x1F"));
}

TEST(GlslTokens, readsVersionsAndProfiles) {
    EXPECT_EQ(scanGlsl("void main(){}", false).version, 110);
    EXPECT_FALSE(scanGlsl("void main(){}", false).es);
    EXPECT_EQ(scanGlsl("void main(){}", true).version, 100);
    EXPECT_TRUE(scanGlsl("void main(){}", true).es);
    EXPECT_TRUE(scanGlsl("#version 300 es\n", false).es);
    EXPECT_EQ(scanGlsl("/* x */\n  #  version 450 core\n", false).version, 450);
    EXPECT_FALSE(scanGlsl("#version 330 compatibility\nes", true).es);
    EXPECT_TRUE(scanGlsl("#version 100\n", false).es);
}

TEST(GlslTokens, endsDirectivesWithTheirLine) {
    const std::string source = "#version 330\n#define A \\\n main\nint b;\n";
    const GlslText t = scanGlsl(source, false);
    ASSERT_EQ(t.directives.size(), 2u);
    EXPECT_EQ(source.substr(t.directives[1].end), "int b;\n");
    for (const GlslToken& token : t.tokens)
        EXPECT_EQ(token.directive, token.text != "int" && token.text != "b" && token.text != ";") << token.text;
}

std::string behind(const std::string& source) { return source.substr(scanGlsl(source, false).declarationsAt()); }

TEST(GlslTokens, placesDeclarationsAfterAllExtensions) {
    EXPECT_EQ(behind("int a;"), "int a;");
    EXPECT_EQ(behind("#version 330\nint a;"), "int a;");
    EXPECT_EQ(behind("#version 330\n#extension X : enable\nint a;"), "int a;");
    EXPECT_EQ(behind("#ifdef X\n#extension X : enable\n#if 1\n#endif\n#endif\nint a;"), "int a;");
    EXPECT_EQ(behind("#extension X : enable\n#ifdef GL_ES\nprecision mediump float;\n#endif\nint a;"),
              "#ifdef GL_ES\nprecision mediump float;\n#endif\nint a;");
    EXPECT_EQ(behind("#if A\n#extension X : enable\n#else\n#extension Y : enable\n#endif\nint a;"), "int a;");
}

TEST(GlslTokens, appliesEditsInOrderOfPosition) {
    TextEdits edits;
    edits.insert(3, "x");
    edits.replace(0, 1, "AA");
    edits.insert(3, "y");
    EXPECT_EQ(edits.apply("abc"), "AAbcxy");
}

TEST(GlslTokens, acceptsAnyBytes) {
    for (const char* text : {"/*", "#", "#if", "\\", "\"", "//", "#endif\n#endif\n", "\xff\xfe", "#version",
                             "#version x", "#version 99999999999"}) {
        const GlslText t = scanGlsl(text, false);
        EXPECT_LE(t.declarationsAt(), std::string_view(text).size()) << text;
    }
}

} // namespace
} // namespace mural::shaders
