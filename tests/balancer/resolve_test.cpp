// Resolution of a file: destination channels, implicit compounds and canvases, defaults, old versions.
#include <gtest/gtest.h>

#include "balancer/config/resolve.hpp"
#include "balancer/config/screen.hpp"
#include "balancer/config/eqc/parser.hpp"

namespace mural::config {

namespace {

struct Resolved {
    ResolvedConfig config;
    std::vector<std::string> lines;
    int errors = 0;
};

Resolved resolved(const std::string& text, const Globals& environment = {}) {
    Diagnostics diagnostics("f");
    Resolved r;
    r.config = resolve(parseConfig(text, diagnostics), environment, diagnostics);
    for (const Diagnostic& d : diagnostics.all()) r.lines.push_back(diagnostics.text(d));
    r.errors = diagnostics.errors();
    return r;
}

const std::string kTwoWindows =
    "appNode { pipe { window { channel { name \"a\" } } window { channel { name \"b\" } } } }";

Resolved with(const std::string& text, const std::string& version = "#Equalizer 1.2 ascii\n") {
    return resolved(version + "config { " + kTwoWindows + text + " }");
}

std::vector<const ResolvedChannel*> destinations(const ResolvedConfig& c) {
    std::vector<const ResolvedChannel*> all;
    for (const ResolvedChannel& channel : c.channels) {
        if (channel.isDestination()) all.push_back(&channel);
    }
    return all;
}

} // namespace

TEST(Resolve, createsDestinationsFromSegmentsAndViews) {
    const Resolved r =
        with("layout { name \"l\" view { viewport [ .25 0 .5 1 ] } view { viewport [ 0 0 .25 1 ] } } canvas { layout 0 "
             "segment { channel \"a\" viewport [ 0 0 .5 1 ] } segment { channel \"b\" viewport [ .5 0 .5 1 ] } }");
    EXPECT_EQ(r.errors, 0);
    const auto all = destinations(r.config);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0]->viewport, (Viewport{.5, 0, .5, 1}));
    EXPECT_EQ(all[1]->viewport, (Viewport{0, 0, .5, 1}));
    EXPECT_EQ(all[1]->name, "b");
    EXPECT_EQ(all[2]->viewport, (Viewport{0, 0, .5, 1}));
    // No compound draws them: adds a group with one compound for each.
    ASSERT_EQ(r.config.roots.size(), 1u);
    EXPECT_EQ(r.config.compounds[0].name, "l");
    EXPECT_EQ(r.config.compounds[0].children.size(), 3u);
    // No observer is defined: adds one.
    ASSERT_EQ(r.config.observers.size(), 1u);
    EXPECT_EQ(r.config.views[1].observer, 0);
}

TEST(Resolve, computesChannelsInPixels) {
    const Resolved r =
        resolved("config { appNode { pipe { window { channel { name \"a\" viewport [ 10 20 100 50 ] } } } } layout { "
                 "view { viewport [ .5 .5 .5 .5 ] } } canvas { layout 0 segment { channel \"a\" } } }");
    EXPECT_EQ(destinations(r.config).at(0)->viewport, (Viewport{60, 45, 50, 25}));
}

TEST(Resolve, resolvesReferencesToChannels) {
    const std::string displays = "layout { name \"one\" view { } } layout { name \"two\" view { name \"v\" } view { "
                                 "name \"w\" viewport [ 0 0 .5 1 ] } } canvas { name \"c\" layout 0 layout 1 segment { "
                                 "name \"s\" channel \"a\" } segment { name \"t\" channel \"b\" } }";
    const auto shown = [&](const std::string& transferScale) {
        const Resolved r = with(displays + "compound { channel " + transferScale + " }");
        if (r.errors > 0) return r.lines.back().substr(r.lines.back().find(' ') + 1);
        const ResolvedChannel& c = r.config.channels[static_cast<size_t>(r.config.compounds[0].channel)];
        return r.config.segments[static_cast<size_t>(c.segment)].name + " " + std::to_string(c.view);
    };
    EXPECT_EQ(shown("( )"), "s 0");
    EXPECT_EQ(shown("( segment \"t\" )"), "t 0");
    EXPECT_EQ(shown("( canvas 0 segment 1 layout \"two\" view \"w\" )"), "t 2");
    EXPECT_EQ(shown("( view \"w\" )"), "s 2");
    EXPECT_EQ(shown("( layout 1 )"), "s 1");
    EXPECT_EQ(shown("( segment 5 )"), "there is no segment number 5; check the path of the compound's channel");
    EXPECT_EQ(shown("( canvas \"x\" )"), "there is no canvas \"x\"; check the path of the compound's channel");
    EXPECT_EQ(shown("\"z\""), "unknown channel \"z\"; define it in a window, or choose another one");
}

TEST(Resolve, completesFilesOlderThanCanvases) {
    const Resolved r = with("compound { eye [ LEFT ] channel \"a\" viewport [ 0 0 .5 1 ] wall { bottom_left [ -2 -1 -1 "
                            "] bottom_right [ 2 -1 -1 ] top_left [ -2 1 -1 ] } }",
                            "");
    EXPECT_EQ(r.errors, 0);
    ASSERT_EQ(r.config.canvases.size(), 1u);
    ASSERT_EQ(r.config.segments.size(), 1u);
    EXPECT_EQ(r.config.segments[0].viewport, (Viewport{0, 0, .5, 1}));
    EXPECT_EQ(screenOf(r.config.segments[0].surface).width, 4);
    EXPECT_EQ(r.config.compounds[0].viewport, Viewport{});
    EXPECT_FALSE(r.config.compounds[0].surface);
    // A compound with eyes implied stereo.
    EXPECT_EQ(r.config.views[0].mode, ViewMode::Stereo);
    EXPECT_EQ(r.config.segments[0].eyes, (EyeSet{Eye::Cyclop, Eye::Left}));
    EXPECT_EQ(*r.config.compounds[0].eyes, (EyeSet{Eye::Cyclop, Eye::Left}));
}

TEST(Resolve, findsHostsInOldFiles) {
    const std::string node =
        "config { node { host \"h\" connection { hostname \"c\" } } node { connection { hostname \"d\" } } }";
    EXPECT_EQ(resolved("#Equalizer 1.1 ascii\n" + node).config.nodes[1].host, "c");
    EXPECT_EQ(resolved("#Equalizer 1.1 ascii\n" + node).lines.size(), 1u);
    const Resolved today = resolved("#Equalizer 1.2 ascii\n" + node);
    EXPECT_EQ(today.config.nodes[1].host, "h");
    EXPECT_EQ(today.config.nodes[2].host, "d");
    EXPECT_EQ(today.lines.size(), 1u);
    EXPECT_EQ(resolved(node).config.serverConnections.size(), 1u);
}

TEST(Resolve, appliesPrecedenceOfAttributes) {
    const auto stereo = [](const std::string& global, const std::string& own, const Globals& environment) {
        return resolved("global { " + global + " } config { appNode { pipe { window { attributes { " + own +
                            " } } } } }",
                        environment)
            .config.windows[0]
            .attributes.hintStereo;
    };
    const Globals environment{{"EQ_WINDOW_IATTR_HINT_STEREO", 7}};
    EXPECT_EQ(stereo("", "", {}), value::kAuto);
    EXPECT_EQ(stereo("", "", environment), 7);
    EXPECT_EQ(stereo("EQ_WINDOW_IATTR_HINT_STEREO ON", "", environment), value::kOn);
    EXPECT_EQ(stereo("EQ_WINDOW_IATTR_HINT_STEREO ON", "hint_stereo OFF", environment), value::kOff);
    EXPECT_FALSE(resolved("config { appNode { pipe { window { } } } }").config.windows[0].attributes.hintSwapsync);
}

TEST(Resolve, readsEnvironmentVariables) {
    const std::map<std::string, std::string> set{{"EQ_WINDOW_IATTR_HINT_STEREO", "1"},
                                                 {"EQ_PIPE_IATTR_HINT_THREAD", "OFF"},
                                                 {"EQ_CONFIG_FATTR_EYE_BASE", "x"},
                                                 {"EQ_CONNECTION_SATTR_HOSTNAME", "a \"b"},
                                                 {"EQ_NODE_CATTR_LAUNCH_COMMAND_QUOTE", "\""}};
    Diagnostics diagnostics("f");
    const Globals globals = globalsOfEnvironment(
        [&](const std::string& name) { return set.contains(name) ? std::optional(set.at(name)) : std::nullopt; },
        diagnostics);
    EXPECT_EQ(std::get<int32_t>(globals.at("EQ_WINDOW_IATTR_HINT_STEREO")), 1);
    EXPECT_EQ(std::get<int32_t>(globals.at("EQ_PIPE_IATTR_HINT_THREAD")), 0);
    EXPECT_EQ(std::get<std::string>(globals.at("EQ_CONNECTION_SATTR_HOSTNAME")), "a \"b");
    EXPECT_EQ(std::get<char>(globals.at("EQ_NODE_CATTR_LAUNCH_COMMAND_QUOTE")), '"');
    EXPECT_EQ(globals.size(), 4u);
    ASSERT_EQ(diagnostics.all().size(), 1u);
    EXPECT_EQ(diagnostics.text(diagnostics.all()[0]),
              "f: environment variable EQ_CONFIG_FATTR_EYE_BASE:1:1: EQ_CONFIG_FATTR_EYE_BASE cannot be the word x; "
              "use a number; it is ignored");
}

TEST(Resolve, namesFramesAndBarriers) {
    const Resolved r =
        with("compound { name \"root\" channel \"a\" swapbarrier { } compound { channel \"b\" outputframe { } } "
             "compound { name \"n\" outputframe { } inputframe { } } inputframe { } }");
    EXPECT_EQ(r.config.compounds[1].outputFrames[0].name, "frame.b");
    EXPECT_EQ(r.config.compounds[2].outputFrames[0].name, "frame.n");
    EXPECT_EQ(r.config.compounds[0].inputFrames[0].name, "frame.root");
    EXPECT_EQ(r.config.compounds[0].barrier->name, "barrier.root");
    const Resolved shown = with("layout { view { } } canvas { name \"c\" layout 0 swapbarrier { } segment { channel "
                                "\"a\" } segment { channel \"b\" swapbarrier { name \"own\" } } }");
    EXPECT_EQ(shown.config.compounds[1].barrier->name, "barrier.canvas.c");
    EXPECT_EQ(shown.config.compounds[2].barrier->name, "own");
}

TEST(Resolve, subtractsBezels) {
    const std::string wall = "layout { view { } } canvas { layout 0 wall { bottom_left [ -1 -.5 -1 ] bottom_right [ 1 "
                             "-.5 -1 ] top_left [ -1 .5 -1 ] } mural_bezel_mm [ 10 20 30 40 ] ";
    const Resolved r = with(wall + "segment { channel \"a\" viewport [ 0 0 .5 1 ] } segment { channel \"b\" viewport [ "
                                   ".5 0 .5 1 ] mural_bezel_mm [ 0 0 0 0 ] } }");
    EXPECT_EQ(r.errors, 0);
    const Viewport seen = r.config.segments[0].viewport;
    EXPECT_NEAR(seen.x, .005, 1e-12);
    EXPECT_NEAR(seen.w, .5 - .015, 1e-12);
    EXPECT_NEAR(seen.y, .03, 1e-12);
    EXPECT_NEAR(seen.h, 1 - .07, 1e-12);
    EXPECT_EQ(r.config.segments[1].viewport, (Viewport{.5, 0, .5, 1}));
    EXPECT_EQ(with(wall + "segment { channel \"a\" viewport [ 0 0 .01 1 ] } }").lines.back(),
              "f:2:246: bezels cover the whole segment, or are negative; set millimetres of left, right, "
              "bottom and top");
}

TEST(Resolve, rejectsDegenerateWalls) {
    EXPECT_EQ(with("layout { view { } } canvas { layout 0 wall { bottom_right [ -.8 -.5 -1 ] } }").errors, 1);
    EXPECT_EQ(with("layout { view { projection { distance 0 } } }").errors, 1);
    EXPECT_EQ(with("layout { view { projection { fov [ 180 40 ] } } }").errors, 1);
    EXPECT_EQ(with("layout { view { wall { top_left [ 0 .5 -1 ] } } }").errors, 1);
}

TEST(Screen, orientsProjectorsAlongTheirViewingDirection) {
    Projection p;
    p.hpr = {50, 0, 0};
    p.distance = 3;
    p.fov = {54, 40};
    const Screen s = screenOf(p);
    EXPECT_NEAR(s.width, 3.0572, 1e-4);
    EXPECT_NEAR(s.height, 2.1838, 1e-4);
    EXPECT_NEAR(s.center.x, -2.298, 1e-3);
    EXPECT_NEAR(s.center.z, -1.928, 1e-3);
    p.hpr = {0, 30, 0};
    EXPECT_NEAR(screenOf(p).center.y, 1.5, 1e-9); // looks up
    p.hpr = {0, 0, 90};
    EXPECT_NEAR(screenOf(p).right.y, 1, 1e-9); // turned counter-clockwise
    const Screen standard = screenOf(Projection{}), wall = screenOf(Wall{});
    EXPECT_NEAR(standard.width, wall.width, 1e-5);
    EXPECT_NEAR(standard.height, wall.height, 1e-5);
    EXPECT_NEAR(length(standard.center - wall.center), 0, 1e-9);
}

} // namespace mural::config
