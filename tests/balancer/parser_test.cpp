// Parsing of configurations: the syntax of Equalizer's reader, keywords of early releases, and error messages.
#include <gtest/gtest.h>

#include "balancer/config/eqc/parser.hpp"

namespace mural::config {

namespace {

struct Parsed {
    ConfigFile file;
    std::vector<std::string> lines;
    int errors = 0;
};

Parsed parse(const std::string& text, bool strict = false) {
    Diagnostics diagnostics("f", strict);
    Parsed p;
    p.file = parseConfig(text, diagnostics);
    for (const Diagnostic& d : diagnostics.all()) p.lines.push_back(diagnostics.text(d));
    p.errors = diagnostics.errors();
    return p;
}

Parsed inConfig(const std::string& text) { return parse("server { config { " + text + " } }"); }
Parsed inCompound(const std::string& text) { return inConfig("compound { " + text + " }"); }

const Compound& compoundOf(const Parsed& p) { return p.file.config.compounds.at(0); }
const Window& windowOf(const Parsed& p) { return p.file.config.appNode->pipes.at(0).windows.at(0); }

// Expects one error with this line.
void expectError(const std::string& text, const std::string& line) {
    const Parsed p = parse(text);
    EXPECT_EQ(p.errors, 1) << text;
    ASSERT_FALSE(p.lines.empty()) << text;
    EXPECT_EQ(p.lines.back(), line);
}

} // namespace

TEST(Parser, ignoresWhatEqualizersLexerIgnores) {
    const Parsed p = inCompound("viewport [ 0, 0, .5, 1.f ];\r\n range [ 0 +.5 ] // to the end\n# and this\n");
    EXPECT_TRUE(p.lines.empty()) << p.lines.front();
    EXPECT_EQ(compoundOf(p).viewport, (Viewport{0, 0, .5, 1}));
    EXPECT_EQ(compoundOf(p).range, (Range{0, .5}));
}

TEST(Parser, acceptsAFileWithoutAServer) {
    const Parsed p =
        parse("EQ_WINDOW_IATTR_HINT_STEREO ON global { global { EQ_CONFIG_FATTR_EYE_BASE .1 } } config { latency 3 }");
    EXPECT_TRUE(p.lines.empty()) << p.lines.front();
    EXPECT_EQ(p.file.config.latency, 3u);
    EXPECT_EQ(std::get<double>(p.file.globals.at("EQ_CONFIG_FATTR_EYE_BASE")), .1);
}

TEST(Parser, readsTheHeaderAfterComments) {
    EXPECT_EQ(parse("# one\n#Equalizer 1.1 ascii server { config { } }").file.version, 1.1);
    EXPECT_EQ(parse("config { }").file.version, 0);
    const Parsed bad = parse("#Equalizer 1.1\nconfig { }");
    EXPECT_EQ(bad.file.version, 0);
    ASSERT_EQ(bad.lines.size(), 1u);
    EXPECT_EQ(bad.lines[0], "f:1:1: unknown header, it is read as a comment; write: #Equalizer 1.2 ascii");
}

TEST(Parser, acceptsACommentAtTheEnd) { EXPECT_TRUE(parse("config { } # no newline").lines.empty()); }

TEST(Parser, usesTheLastOfRepeatedFields) {
    const Parsed p = inCompound(
        "range [ 0 .1 ] range [ 0 .2 ] eye [ LEFT RIGHT ] eye [ CYCLOP ] wall { } projection { distance 3 }");
    EXPECT_EQ(compoundOf(p).range, (Range{0, .2}));
    EXPECT_EQ(compoundOf(p).eyes, EyeSet{Eye::Cyclop});
    EXPECT_EQ(std::get<Projection>(*compoundOf(p).surface).distance, 3);
}

TEST(Parser, acceptsEmptySets) {
    const Parsed p = inCompound("eye [ LEFT ] eye [ ] task [ ] buffer [ ]");
    EXPECT_FALSE(compoundOf(p).eyes);
    EXPECT_EQ(compoundOf(p).tasks, TaskSet{});
    EXPECT_EQ(compoundOf(p).buffers, BufferSet{});
}

TEST(Parser, resetsTheEyesAtAnEyeBase) {
    const Observer o =
        inConfig("observer { eye_left [ 1 0 0 ] eye_base .1 eye_right [ 2 0 0 ] }").file.config.observers.at(0);
    EXPECT_FALSE(o.eyeLeft);
    EXPECT_EQ(o.eyeRight, (Vector3{2, 0, 0}));
}

TEST(Parser, mergesSectionsOfTheAppNode) {
    const Parsed p = inConfig("appNode { pipe { } } appNode { name \"a\" pipe { } }");
    EXPECT_EQ(p.file.config.appNode->pipes.size(), 2u);
    EXPECT_EQ(p.file.config.appNode->name, "a");
}

TEST(Parser, readsAttributeValues) {
    const Parsed p = inConfig("appNode { pipe { attributes { hint_affinity CORE 3 } window { attributes { planes_color "
                              "RGBA16F hint_drawable pbuffer planes_depth 24 } } } }");
    EXPECT_EQ(p.file.config.appNode->pipes[0].attributes.hintAffinity, value::kCore + 3);
    EXPECT_EQ(windowOf(p).attributes.planesColor, value::kRgba16f);
    EXPECT_EQ(windowOf(p).attributes.hintDrawable, value::kFbo);
    EXPECT_EQ(windowOf(p).attributes.planesDepth, 24);
}

TEST(Parser, reportsPositionProblemAndRemedyOfUnknownWords) {
    const Parsed p = parse("server { config {\n  latancy 3\n  latency 2 } }");
    ASSERT_EQ(p.lines.size(), 1u);
    EXPECT_EQ(p.lines[0],
              "f:2:3: section config has no field latancy, it is ignored; check its spelling, or remove it");
    EXPECT_EQ(p.file.config.latency, 2u);
    EXPECT_EQ(p.errors, 0);
    EXPECT_EQ(parse("server { config { latancy 3 } }", true).errors, 1);
}

TEST(Parser, skipsUnknownSections) {
    const Parsed p = inConfig("particles { count 3 { deep [ 1 2 ] } } latency 4");
    EXPECT_EQ(p.lines.size(), 1u);
    EXPECT_EQ(p.file.config.latency, 4u);
}

// All keywords of early releases.
TEST(Parser, acceptsLoadBalancersOfEarlyReleases) {
    Parsed p = inCompound("loadBalancer { mode DB damping .3 boundary .01 }");
    EXPECT_EQ(std::get<LoadEqualizer>(compoundOf(p).equalizers.at(0)).mode, SplitMode::Db);
    EXPECT_EQ(std::get<LoadEqualizer>(compoundOf(p).equalizers.at(0)).damping, .3);
    EXPECT_EQ(p.lines.at(0), "f:1:30: loadBalancer was renamed to load_equalizer; write load_equalizer");
    EXPECT_TRUE(std::holds_alternative<FramerateEqualizer>(
        compoundOf(inCompound("loadBalancer { mode DPLEX }")).equalizers.at(0)));
    EXPECT_EQ(std::get<DfrEqualizer>(compoundOf(inCompound("loadBalancer { mode DFR framerate 20 }")).equalizers.at(0))
                  .frameRate,
              20);
    for (const char* mode : {"MONITOR", "DDS"}) {
        EXPECT_TRUE(std::holds_alternative<MonitorEqualizer>(
            compoundOf(inCompound(std::string("loadBalancer { mode ") + mode + " }")).equalizers.at(0)));
    }
}

TEST(Parser, acceptsResourcesOfEarlyReleases) {
    const Parsed p = inConfig("appNode { connection { type SDP TCPIP_port 4 command \"rsh %h %c\" command_quote '\"' "
                              "timeout 100 } connection { type MCIP PIPE_filename \"x\" } connection { type IB }"
                              " pipe { display 1 screen 2 window { hints { stereo on hint_fullscreen OFF } attributes "
                              "{ planes { stencil 8 } } channel { drawable [ FBO_COLOR FBO_DEPTH ] } } } }");
    const Node& n = *p.file.config.appNode;
    EXPECT_EQ(p.errors, 0);
    EXPECT_EQ(n.connections[0].type, ConnectionType::Tcp);
    EXPECT_EQ(n.connections[0].port, 4u);
    EXPECT_EQ(n.connections[1].type, ConnectionType::Rsp);
    EXPECT_EQ(n.connections[1].filename, "x");
    EXPECT_EQ(n.connections[2].type, ConnectionType::Rdma);
    EXPECT_EQ(n.attributes.launchCommand, "rsh %h %c");
    EXPECT_EQ(n.attributes.launchCommandQuote, '"');
    EXPECT_EQ(n.attributes.launchTimeout, 100);
    EXPECT_EQ(n.pipes[0].port, 1u);
    EXPECT_EQ(n.pipes[0].device, 2u);
    EXPECT_EQ(windowOf(p).attributes.hintStereo, value::kOn);
    EXPECT_EQ(windowOf(p).attributes.hintFullscreen, value::kOff);
    EXPECT_EQ(windowOf(p).attributes.planesStencil, 8);
    EXPECT_EQ(p.lines.size(), 14u);
}

TEST(Parser, acceptsOtherKeywordsOfEarlyReleases) {
    Parsed p = inConfig("attributes { eyeBase .1 focus_distance 2 focus_mode relative_to_origin } observer { eyeBase "
                        ".2 } layout { view { attributes { displaycluster \"h\" } } }"
                        " compound { buffers [ COLOR STENCIL depth ] format RGBA8 attributes { update_FOV ON "
                        "stereo_mode quad stereo_anaglyph_left_mask [ red ] } }");
    EXPECT_EQ(p.errors, 0) << p.lines.back();
    EXPECT_EQ(p.file.config.attributes.eyeBase, .1);
    EXPECT_EQ(p.file.config.observers.at(0).eyeBase, .2);
    EXPECT_EQ(p.file.config.observers.at(0).focusDistance, 2);
    EXPECT_EQ(p.file.config.observers.at(0).focusMode, FocusMode::RelativeToOrigin);
    EXPECT_EQ(compoundOf(p).buffers, (BufferSet{Buffer::Color, Buffer::Depth}));
    EXPECT_EQ(compoundOf(p).attributes.stereoMode, value::kQuad);
    EXPECT_EQ(compoundOf(p).attributes.anaglyphLeftMask, ColorMask{ColorComponent::Red});
    p = parse("global { EQ_CONNECTION_HOSTNAME \"h\" EQ_CONNECTION_IATTR_TCPIP_PORT 3 EQ_WINDOW_HINT_STEREO ON "
              "EQ_VIEW_SATTR_DISPLAYCLUSTER \"x\" } config { }");
    EXPECT_EQ(p.errors, 0);
    EXPECT_EQ(std::get<std::string>(p.file.globals.at("EQ_CONNECTION_SATTR_HOSTNAME")), "h");
    EXPECT_EQ(std::get<int32_t>(p.file.globals.at("EQ_CONNECTION_IATTR_PORT")), 3);
    EXPECT_EQ(std::get<int32_t>(p.file.globals.at("EQ_WINDOW_IATTR_HINT_STEREO")), 1);
    EXPECT_EQ(p.lines.size(), 4u);
}

TEST(Parser, reportsEachErrorInOneLine) {
    expectError("", "f:1:1: the file contains no configuration; it begins with: server { config {");
    expectError("config { name \"x }", "f:1:15: this string is not terminated; close it with \" on the same line");
    expectError("config { latency -1 }", "f:1:18: latency cannot be negative; use 0 or more");
    expectError("config { latency 1.5 }", "f:1:18: latency cannot be the number 1.5; use a whole number");
    expectError("config { latency 99999999999 }", "f:1:18: latency is too large; use a number below 2147483648");
    expectError("config { compound { range [ 0 1 2 ] } }",
                "f:1:33: range ends with ], found the number 2; add it, or check for a missing bracket before it");
    expectError("config { compound { range 0 }", "f:1:27: range begins with [, found the number 0; add it");
    expectError("config { compound { range [ 0 " + std::string(400, '9') + " ] } }",
                "f:1:31: range is too large; use a smaller number");
    expectError(
        "config { 3 }",
        "f:1:10: the number 3 is not a field of section config; remove it, or check for a missing bracket before it");
    expectError("config { layout { view { mode FISH } } }",
                "f:1:31: mode cannot be the word FISH; use one of MONO, STEREO");
    expectError("config { node {", "f:1:16: section node ends with }, found the end of the file; add it, or check for "
                                   "a missing bracket before it");
}

TEST(Parser, reportsDeepNestingInOneLine) {
    std::string text = "config { ";
    for (int i = 0; i < 100'000; ++i) text += "compound { ";
    const Parsed p = parse(text);
    EXPECT_EQ(p.errors, 1);
    EXPECT_EQ(p.lines.back().substr(p.lines.back().find(' ') + 1),
              "more than 200 sections are nested; check the brackets");
}

TEST(Parser, reportsEveryTruncatedFileInOneLine) {
    const std::string whole =
        "#Equalizer 1.2 ascii\nglobal { EQ_CONFIG_FATTR_EYE_BASE .1 }\nserver { connection { type RSP } config { "
        "appNode { pipe { window { viewport [ 0 0 1 1 ] channel { name \"c\" } } } }"
        " compound { channel ( segment 0 view \"v\" ) eye [ LEFT ] load_equalizer { boundary [ 1 2 ] } } } }";
    for (size_t n = 0; n + 2 < whole.size(); ++n) EXPECT_LE(parse(whole.substr(0, n)).errors, 1) << n;
    EXPECT_EQ(parse(whole).errors, 0);
}

TEST(Parser, reportsFewLinesForABinaryFile) {
    std::string noise;
    for (int i = 0; i < 100'000; ++i) noise += static_cast<char>(i * 7919 >> 3);
    EXPECT_LE(parse(noise).lines.size(), 200u);
    Diagnostics diagnostics("/nonexistent/x.eqc");
    readConfigFile("/nonexistent/x.eqc", diagnostics);
    EXPECT_EQ(diagnostics.firstError(),
              "/nonexistent/x.eqc: cannot be read: No such file or directory; check the name and its permissions");
    Diagnostics folder("/");
    readConfigFile("/", folder);
    EXPECT_EQ(folder.errors(), 1);
}

} // namespace mural::config
