// Node setups that follow from a configuration file.
#include "nodes/head/planning/balance_plan.hpp"
#include "nodes/head/planning/config_plan.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <unistd.h>

#include "balancer/config/presets.hpp"
#include "balancer/equalizers/make_equalizers.hpp"
#include "compositor/strategies/choose_strategy.hpp"
#include "nodes/head/planning/composition_choice.hpp"
#include "tests/balancer/example_files.hpp"

namespace mural {
namespace {

compound::LoadedConfig load(const std::string& name) {
    return compound::loadConfig(std::string(MURAL_SOURCE_DIR) + "/configs/" + name,
                                [](const std::string&) { return std::optional<std::string>(); });
}
SessionPlan planOfFile(const std::string& name, bool here = true) {
    const auto loaded = load(name);
    EXPECT_TRUE(loaded.ok()) << loaded.diagnostics.firstError();
    auto plan = planOf(loaded, {"me", here, "", {}});
    EXPECT_TRUE(plan.ok()) << (plan.ok() ? "" : plan.error().message);
    return plan.ok() ? std::move(*plan) : SessionPlan{};
}

TEST(ConfigPlan, givesRangesACommonPictureAndCollector) {
    const SessionPlan plan = planOfFile("db.eqc");
    ASSERT_GE(plan.nodes.size(), 2u);
    double end = 0;
    for (const NodePlan& n : plan.nodes) {
        EXPECT_EQ(n.picture, 0);
        EXPECT_EQ(n.collector, 0);
        EXPECT_EQ(n.pass.ranges, static_cast<int>(plan.nodes.size()));
        EXPECT_EQ(n.pass.range, n.node) << "in the order of their ranges";
        EXPECT_DOUBLE_EQ(n.pass.share.start, end);
        EXPECT_EQ(n.answers, n.node == 0);
        end = n.pass.share.end;
    }
    EXPECT_DOUBLE_EQ(end, 1);
}

SessionPlan planOfRanges(const std::string& composition) {
    config::Preset form;
    form.ranges = 5;
    form.composition = composition;
    const auto file = config::shortForm(form);
    const auto loaded = compound::loadConfig(file.value(), "ranges.eqc",
                                             [](const std::string&) { return std::optional<std::string>(); });
    auto plan = planOf(loaded, {"me", true, "", {}});
    EXPECT_TRUE(plan.ok()) << (plan.ok() ? "" : plan.error().message);
    return plan.ok() ? std::move(*plan) : SessionPlan{};
}

TEST(ConfigPlan, readsTheCompositionOfRanges) {
    using compositor::Strategy;
    const auto chosen = [](SessionPlan plan, const std::string& composition) {
        chooseComposition(plan, composition);
        for (const NodePlan& n : plan.nodes) EXPECT_EQ(n.composition, plan.nodes[0].composition);
        return plan.nodes[0].composition.value_or(Strategy::Serial);
    };
    EXPECT_EQ(chosen(planOfRanges("streaming"), "auto"), Strategy::Streaming);
    EXPECT_EQ(chosen(planOfRanges("streaming"), "radix-k"), Strategy::RadixK)
        << "the command line counts before the file";
    EXPECT_EQ(chosen(planOfRanges("auto"), "auto"), compositor::chooseStrategy(5));
    EXPECT_EQ(chosen(planOfRanges(""), "auto"), compositor::chooseStrategy(5));
}

TEST(ConfigPlan, placesPartsOfTheWallSideBySide) {
    // The monitors of the first file have bezels, behind which nothing is drawn.
    for (const auto& [file, whole] : {std::pair("wall-2x2.eqc", 0.930896), std::pair("2d.eqc", 1.0)}) {
        const SessionPlan plan = planOfFile(file);
        double covered = 0;
        for (const NodePlan& n : plan.nodes) {
            ASSERT_TRUE(n.area.has_value());
            EXPECT_EQ(n.pass.ranges, 1);
            covered += n.area->w * n.area->h;
            for (const NodePlan& other : plan.nodes)
                EXPECT_TRUE(other.node == n.node || intersect(*n.area, *other.area).empty()) << file;
        }
        EXPECT_NEAR(covered, whole, 1e-6) << file;
        EXPECT_EQ(picturesOf(plan.wall), static_cast<int>(plan.wall.parts.size())) << "one for each destination";
    }
}

TEST(ConfigPlan, drawsOnePictureInPhases) {
    const SessionPlan plan = planOfFile("dplex.eqc");
    ASSERT_GE(plan.nodes.size(), 2u);
    std::vector<bool> phases(static_cast<size_t>(plan.nodes.front().pass.period), false);
    for (const NodePlan& n : plan.nodes) {
        EXPECT_EQ(n.picture, 0);
        EXPECT_EQ(n.pass.ranges, 1);
        phases[static_cast<size_t>(n.pass.phase)] = true;
    }
    EXPECT_EQ(std::count(phases.begin(), phases.end(), true), static_cast<long>(phases.size()));
}

TEST(ConfigPlan, drawsWholePicturesForSamplesAndPixels) {
    const SessionPlan samples = planOfFile("subpixel.eqc"), pixels = planOfFile("pixel.eqc");
    EXPECT_EQ(picturesOf(samples.wall), samples.wall.parts.front().counts.samples);
    EXPECT_GT(samples.wall.parts.front().counts.samples, 1);
    EXPECT_EQ(picturesOf(pixels.wall),
              pixels.wall.parts.front().counts.kernelWidth * pixels.wall.parts.front().counts.kernelHeight);
    EXPECT_GT(picturesOf(pixels.wall), 1);
    for (const SessionPlan* plan : {&samples, &pixels}) {
        std::set<int> made;
        for (const NodePlan& n : plan->nodes) made.insert(n.picture);
        EXPECT_EQ(static_cast<int>(made.size()), picturesOf(plan->wall));
        EXPECT_TRUE(plan->warnings.empty()) << plan->warnings.front();
    }
}

TEST(ConfigPlan, combinesEyes) {
    const SessionPlan plan = planOfFile("stereo-anaglyph.eqc");
    EXPECT_EQ(plan.wall.stereo, StereoMode::Anaglyph);
    ASSERT_EQ(plan.wall.parts.size(), 2u);
    EXPECT_NE(plan.wall.parts[0].eye, plan.wall.parts[1].eye);
    EXPECT_NEAR(plan.eyeBase.value_or(0), .065, 1e-9) << "the observer's";
    EXPECT_EQ(planOfFile("stereo-passive.eqc").wall.stereo, StereoMode::SideBySide);
}

TEST(ConfigPlan, usesTheColoursOfTheFileForEyes) {
    const auto coloursOf = [](const SessionPlan& plan, Eye eye) {
        for (const WallPart& part : plan.wall.parts)
            if (part.eye == eye) return part.colours;
        return EyeColours{false, false, false};
    };
    const SessionPlan cyan = planOfFile("stereo-anaglyph.eqc");
    EXPECT_EQ(coloursOf(cyan, Eye::Left), (EyeColours{true, false, false}));
    EXPECT_EQ(coloursOf(cyan, Eye::Right), (EyeColours{false, true, true})) << "which another channel draws";

    std::ifstream from(std::string(MURAL_SOURCE_DIR) + "/configs/stereo-anaglyph.eqc");
    std::string text((std::istreambuf_iterator<char>(from)), std::istreambuf_iterator<char>());
    const std::string mode = "stereo_mode ANAGLYPH";
    text.insert(text.find(mode) + mode.size(),
                " stereo_anaglyph_left_mask [ GREEN ] stereo_anaglyph_right_mask [ RED BLUE ]");
    const auto path = std::filesystem::temp_directory_path() / ("mural-magenta-" + std::to_string(getpid()) + ".eqc");
    std::ofstream(path) << text;
    const auto loaded =
        compound::loadConfig(path.string(), [](const std::string&) { return std::optional<std::string>(); });
    std::filesystem::remove(path);
    const auto plan = planOf(loaded, {"me", true, "", {}});
    ASSERT_TRUE(plan.ok());
    EXPECT_EQ(coloursOf(plan.value(), Eye::Left), (EyeColours{false, true, false}));
    EXPECT_EQ(coloursOf(plan.value(), Eye::Right), (EyeColours{true, false, true}));
}

TEST(ConfigPlan, sizesTheWallByItsSegments) {
    const auto loaded = load("wall-2x2.eqc");
    const auto size = wallSizeOf(loaded, {"me", true, "", {}});
    EXPECT_GT(size.w, 0);
    EXPECT_GT(size.h, 0);
    int tiles = 0;
    for (const config::ResolvedSegment& s : loaded.resolved.segments) tiles += s.channel != config::kNone;
    EXPECT_EQ(tiles, 4);
}

TEST(ConfigPlan, treatsScreensAtAnglesAsARoom) {
    const SessionPlan plan = planOfFile("cave.eqc");
    ASSERT_EQ(plan.nodes.size(), 3u);
    const double xs[] = {-1, 0, 1}; // where the centre of each wall is seen
    for (size_t i = 0; i < 3; ++i) {
        const NodePlan& n = plan.nodes[i];
        ASSERT_TRUE(n.screen) << i;
        EXPECT_NEAR(n.screen->area.x, n.area->x, 1e-12);
        EXPECT_NEAR(n.screen->left, -1, 1e-12);
        EXPECT_NEAR(n.screen->right, 1, 1e-12);
        EXPECT_NEAR(n.screen->top, .75, 1e-12);
        const Vector3 middle = transformPoint(n.screen->fromProgram, {xs[i], 0, i == 1 ? -1. : 0.});
        EXPECT_NEAR(middle.x, 0, 1e-12) << i;
        EXPECT_NEAR(middle.z, -1, 1e-12) << i;
        EXPECT_EQ(nodeSetupFromJson(toJson(setupOf({}, plan, n)))->screen, n.screen);
    }
}

TEST(ConfigPlan, selectsTheViewpointByProjection) {
    const auto screens = [](const std::string& file, ProjectionChoice projection) {
        auto plan = planOf(load(file), {"me", true, "", {}, projection});
        EXPECT_TRUE(plan.ok());
        return std::ranges::count_if(plan->nodes, [](const NodePlan& n) { return n.screen.has_value(); });
    };
    EXPECT_EQ(screens("cave.eqc", ProjectionChoice::Program), 0);
    EXPECT_EQ(screens("cave.eqc", ProjectionChoice::Auto), 3);
    EXPECT_EQ(screens("wall-2x2.eqc", ProjectionChoice::Auto), 0) << "flat";
    EXPECT_EQ(screens("wall-2x2.eqc", ProjectionChoice::Room), 4);
}

// An eye half a metre to the right is half a metre in the program's units.
TEST(ConfigPlan, convertsEyesToTheProgramsUnits) {
    const auto loaded = load("stereo-passive.eqc");
    for (const double unit : {1., 100.}) {
        auto plan = planOf(loaded, {"me", true, "", {}, ProjectionChoice::Room, unit});
        ASSERT_TRUE(plan.ok());
        for (const NodePlan& n : plan->nodes)
            EXPECT_NEAR(n.screen->fromProgram.m[0][3], (n.pass.eye == Eye::Left ? .0325 : -.0325) * unit, 1e-9);
    }
}

TEST(ConfigPlan, showsChannelsOnTheirNodes) {
    SessionConfig windows;
    windows.display = Display::Windows;
    windows.windowX = 5;
    const SessionPlan plan = planOfFile("wall-2x2.eqc", false);
    EXPECT_FALSE(headShowsWall(windows, plan));
    std::set<std::string> displays;
    for (const NodePlan& n : plan.nodes) {
        const NodeSetup setup = setupOf(windows, plan, n);
        EXPECT_TRUE(setup.wallWindows);
        EXPECT_TRUE(setup.fullScreen) << "as the file says";
        EXPECT_FALSE(setup.windowAsOnWall);
        EXPECT_EQ(setup.windowX, 5);
        EXPECT_EQ(setup.windowTitle.find("Mural "), 0u);
        EXPECT_FALSE(setup.sendPictures) << "nothing is shown or saved elsewhere";
        displays.insert(setup.displayName);
    }
    EXPECT_EQ(displays, (std::set<std::string>{":0.0", ":0.1"}));
    const SessionPlan here = planOfFile("wall-2x2.eqc");
    EXPECT_FALSE(headShowsWall(windows, here));
    for (const NodePlan& n : here.nodes)
        EXPECT_TRUE(setupOf(windows, here, n).windowAsOnWall && !setupOf(windows, here, n).fullScreen);
}

TEST(ConfigPlan, createsTileQueues) {
    const SessionPlan planned = planOfFile("tile-queue.eqc");
    ASSERT_EQ(planned.nodes.size(), 3u);
    SessionPlan plan = planned;
    settleBalance(plan, {});
    for (const NodePlan& n : plan.nodes) EXPECT_TRUE(n.movesArea);
    EXPECT_TRUE(plan.warnings.empty());
    EXPECT_EQ(plan.balance->equalizers.size(), 1u);
    SessionConfig lean;
    lean.tiling = Tiling::Lean;
    plan = planned;
    settleBalance(plan, lean);
    for (const NodePlan& n : plan.nodes) EXPECT_FALSE(n.movesArea);
    EXPECT_EQ(plan.warnings.size(), 1u);
    EXPECT_TRUE(plan.balance->equalizers.empty());
    SessionPlan projector = planOfFile("tiles-copy.eqc");
    settleBalance(projector, {});
    EXPECT_FALSE(projector.balance->equalizers.empty()) << "by a tile_equalizer";
}

TEST(ConfigPlan, createsChunkQueues) {
    SessionPlan plan = planOfFile("chunk-queue.eqc");
    ASSERT_EQ(plan.nodes.size(), 3u);
    settleBalance(plan, {});
    int range = 0;
    for (const NodePlan& n : plan.nodes) {
        EXPECT_TRUE(n.movesRange);
        EXPECT_FALSE(n.movesArea);
        EXPECT_EQ(n.pass.range, range++);
        EXPECT_EQ(n.pass.ranges, 3);
    }
    EXPECT_TRUE(plan.warnings.empty());
    EXPECT_NE(plan.explain.back().find("divides the draws among nodes 0, 1 and 2"), std::string::npos)
        << plan.explain.back();
}

// The collector shows the picture of ranges. The head shows what several pictures compose, and both eyes on one screen.
TEST(ConfigPlan, selectsTheNodeThatShowsComposedPictures) {
    SessionConfig windows;
    windows.display = Display::Windows;
    for (const char* file : {"db.eqc", "cave.eqc"}) EXPECT_FALSE(headShowsWall(windows, planOfFile(file))) << file;
    for (const char* file :
         {"2d.eqc", "subpixel.eqc", "pixel.eqc", "dplex.eqc", "stereo-anaglyph.eqc", "stereo-passive.eqc"})
        EXPECT_TRUE(headShowsWall(windows, planOfFile(file))) << file;
    EXPECT_FALSE(headShowsWall(windows, planOfFile("stereo-passive.eqc", false))) << "each eye has a projector";
}

TEST(ConfigPlan, rejectsAnUnknownLayout) {
    const auto plan = planOf(load("db.eqc"), {"me", true, "", {"nowhere"}});
    ASSERT_FALSE(plan.ok());
    EXPECT_NE(plan.error().message.find("--layout \"nowhere\""), std::string::npos) << plan.error().message;
}

// In a folder of this process, because tests run concurrently.
std::filesystem::path ownFile(const std::string& name) {
    const auto folder = std::filesystem::path(::testing::TempDir()) / ("config_plan." + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    return folder / name;
}
void forget(const std::filesystem::path& file) { std::filesystem::remove_all(file.parent_path()); }

Result<SessionPlan> planOfText(const std::string& compounds) {
    const auto path = ownFile("config_plan_test.eqc");
    std::ofstream(path) << "#Equalizer 1.2 ascii\nserver { config { appNode { pipe { window { viewport [ 0 0 321 200 ] "
                           "channel { name \"a\" } } window { viewport [ 0 0 321 200 ] channel { name \"b\" } } } }\n"
                           "layout { view { } } canvas { layout 0 wall { } segment { channel \"a\" } }\ncompound { "
                           "channel ( ) buffer [ COLOR DEPTH ] "
                        << compounds << " inputframe { name \"frame.b\" } } } }\n";
    const auto loaded =
        compound::loadConfig(path.string(), [](const std::string&) { return std::optional<std::string>(); });
    forget(path);
    EXPECT_TRUE(loaded.ok()) << loaded.diagnostics.firstError();
    return planOf(loaded, {"me", true, "", {}});
}

TEST(ConfigPlan, multipliesZooms) {
    auto plan = planOfText("zoom [ .5 1 ] compound { viewport [ 0 0 .5 1 ] } compound { channel \"b\" viewport [ .5 0 "
                           ".5 1 ] zoom [ .5 .5 ] outputframe { } }");
    ASSERT_TRUE(plan) << plan.error().message;
    ASSERT_EQ(plan->nodes.size(), 2u);
    EXPECT_EQ(plan->nodes[0].pass.zoom, (Zoom{.5, 1}));
    EXPECT_EQ(plan->nodes[1].pass.zoom, (Zoom{.25, .5})) << "whatever whole pixels their channels have";
    EXPECT_EQ(plan->nodes[0].picture, plan->nodes[1].picture);
    auto larger = planOfText("compound { viewport [ 0 0 .5 1 ] } compound { channel \"b\" viewport [ .5 0 .5 1 ] zoom "
                             "[ 2 .5 ] outputframe { } }");
    ASSERT_TRUE(larger) << larger.error().message;
    EXPECT_EQ(larger->nodes[1].pass.zoom, (Zoom{2, .5}));
    EXPECT_TRUE(larger->warnings.empty());
}

TEST(ConfigPlan, reportsUnsupportedZooms) {
    auto large = planOfText("compound { viewport [ 0 0 .5 1 ] } compound { channel \"b\" viewport [ .5 0 .5 1 ] zoom [ "
                            "17 .5 ] outputframe { } }");
    ASSERT_TRUE(large) << large.error().message;
    EXPECT_EQ(large->nodes[1].pass.zoom, (Zoom{kMaxZoom, .5}));
    ASSERT_EQ(large->warnings.size(), 1u);
    EXPECT_NE(large->warnings[0].find(".eqc:4:"), std::string::npos) << large->warnings[0];
    auto ranges = planOfText(
        "compound { range [ 0 .5 ] } compound { channel \"b\" range [ .5 1 ] zoom [ .5 .5 ] outputframe { } }");
    ASSERT_FALSE(ranges);
    EXPECT_NE(ranges.error().message.find("the same zoom"), std::string::npos) << ranges.error().message;
}

// Nodes that composite one area keep it equal: the equalizer of the first range moves it.
TEST(ConfigPlan, movesTheAreasOfRangesTogether) {
    const auto settled = [](SessionPlan plan) {
        settleBalance(plan, {});
        return plan;
    };
    const SessionPlan plan = settled(planOfFile("db-of-areas.eqc"));
    EXPECT_TRUE(plan.warnings.empty()) << plan.warnings.front();
    ASSERT_EQ(plan.nodes.size(), 4u);
    for (const NodePlan& n : plan.nodes) {
        EXPECT_TRUE(n.movesArea && !n.movesRange);
        EXPECT_EQ(n.pass.ranges, 2);
        EXPECT_EQ(n.area, plan.nodes[static_cast<size_t>(n.collector)].area);
    }
    ASSERT_EQ(plan.balance->equalizers.size(), 1u);
    const auto all = balance::makeEqualizers(plan.balance->config, plan.balance->choice);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(plan.balance->equalizers[0], all[0]->id());

    // one equalizer above the ranges has all nodes of each area
    auto above =
        planOfText("load_equalizer { } compound { compound { range [ 0 .5 ] } compound { range [ .5 1 ] channel "
                   "\"b\" outputframe { name \"x\" } } inputframe { name \"x\" } } compound { channel \"b\" "
                   "compound { range [ 0 .5 ] } compound { range [ .5 1 ] channel \"a\" outputframe { name "
                   "\"y\" } } inputframe { name \"y\" } outputframe { } }");
    ASSERT_TRUE(above) << above.error().message;
    const SessionPlan whole = settled(*above);
    EXPECT_TRUE(whole.warnings.empty()) << whole.warnings.front();
    ASSERT_EQ(whole.nodes.size(), 4u);
    for (const NodePlan& n : whole.nodes) EXPECT_TRUE(n.movesArea);
}

TEST(ConfigPlan, changesTheZoomsOfNodesBelowADfrEqualizer) {
    const auto settled = [](const std::string& compounds) {
        auto plan = planOfText(compounds);
        EXPECT_TRUE(plan) << plan.error().message;
        settleBalance(*plan, {});
        return *plan;
    };
    const std::string left = "compound { viewport [ 0 0 .5 1 ] } ";
    const SessionPlan one =
        settled(left + "compound { channel \"b\" viewport [ .5 0 .5 1 ] DFR_equalizer { } outputframe { } }");
    EXPECT_TRUE(one.warnings.empty());
    EXPECT_FALSE(one.nodes[0].movesZoom);
    EXPECT_TRUE(one.nodes[1].movesZoom && !one.nodes[1].movesArea);
    const NodeSetup first = setupOf({}, one, one.nodes[0]), second = setupOf({}, one, one.nodes[1]);
    EXPECT_TRUE(first.areas.empty() && first.anyMovesZoom && !first.movesZoom);
    EXPECT_TRUE(second.areas.size() == 8 && second.anyMovesZoom && second.movesZoom);
    EXPECT_TRUE(nodeSetupFromJson(toJson(second))->movesZoom);
    const SessionPlan all = settled("compound { DFR_equalizer { } load_equalizer { } compound { } compound { channel "
                                    "\"b\" outputframe { } } }");
    EXPECT_TRUE(all.warnings.empty());
    for (const NodePlan& n : all.nodes) EXPECT_TRUE(n.movesZoom && n.movesArea);
    const std::string ranges = "compound { range [ 0 .5 ] } compound { channel \"b\" range [ .5 1 ] ";
    const std::string turns = "compound { period 2 phase 0 } compound { channel \"b\" period 2 phase 1 ";
    for (const std::string& other : {ranges, turns}) {
        const SessionPlan fixed = settled(other + "DFR_equalizer { } outputframe { } }");
        for (const NodePlan& n : fixed.nodes) EXPECT_FALSE(n.movesZoom);
        ASSERT_EQ(fixed.warnings.size(), 1u);
        EXPECT_NE(fixed.warnings[0].find("the zoom stays fixed: "), std::string::npos) << fixed.warnings[0];
    }
    const SessionPlan together = settled("compound { DFR_equalizer { } " + ranges + "outputframe { } } }");
    EXPECT_TRUE(together.warnings.empty());
    for (const NodePlan& n : together.nodes) EXPECT_TRUE(n.movesZoom);
}

// Fields without effect are reported with position and remedy.
TEST(ConfigPlan, reportsFieldsWithoutEffect) {
    const auto path = ownFile("config_plan_fields.eqc");
    std::ofstream(path)
        << "#Equalizer 1.2 ascii\nserver { config { appNode { connection { type TCPIP } pipe { window { "
           "viewport [ 0 0 320 200 ]\nattributes { hint_swapsync ON } channel { name \"a\" } } } }\n"
           "layout { view { } } canvas { layout 0 wall { } segment { channel \"a\" } }\n"
           "compound { channel ( ) } } }\n";
    const auto loaded =
        compound::loadConfig(path.string(), [](const std::string&) { return std::optional<std::string>(); });
    forget(path);
    auto plan = planOf(loaded, {"me", true, "", {}});
    ASSERT_TRUE(plan) << plan.error().message;
    ASSERT_EQ(plan->warnings.size(), 2u) << plan->warnings.front();
    EXPECT_NE(plan->warnings[0].find("config_plan_fields.eqc:2:29: connection has no effect"), std::string::npos)
        << plan->warnings[0];
    EXPECT_NE(plan->warnings[1].find(":3:14: hint_swapsync has no effect"), std::string::npos) << plan->warnings[1];
    EXPECT_NE(plan->warnings[0].find("; "), std::string::npos) << "a remedy";
    EXPECT_TRUE(planOfText("compound { viewport [ 0 0 .5 1 ] } compound { channel \"b\" viewport [ .5 0 .5 1 ] zoom [ "
                           ".5 .5 ] outputframe { } }")
                    ->warnings.empty())
        << "that one has";
}

// The second channel's picture is exported in part: the screen's own draws are visible around it.
TEST(ConfigPlan, placesPartialFramesOnTheWall) {
    auto plan =
        planOfText("compound { } compound { channel \"b\" outputframe { viewport [ .5 .5 .5 .5 ] buffer [ COLOR ] } }");
    ASSERT_TRUE(plan) << plan.error().message;
    double covered = 0;
    int others = 0;
    for (const NodePlan& n : plan->nodes) {
        covered += n.area->w * n.area->h;
        EXPECT_FALSE(n.shown);
        EXPECT_TRUE(n.transferScale.none());
        for (const NodePlan& o : plan->nodes) EXPECT_TRUE(o.node == n.node || intersect(*n.area, *o.area).empty());
        others += std::abs(n.area->x - .5) < .01 && std::abs(n.area->y - .5) < .01;
    }
    EXPECT_NEAR(covered, 1, 1e-9);
    EXPECT_EQ(others, 1);
    EXPECT_EQ(plan->nodes.size(), 3u) << "an L of two rectangles, and the part";
    EXPECT_FALSE(plan->nodesShowWall);
    auto same = planOfText("compound { } compound { channel \"b\" outputframe { viewport [ .5 .5 .5 .5 ] } }");
    ASSERT_TRUE(same) << same.error().message;
    EXPECT_EQ(same->nodes.size(), 1u) << "with depth, what is there stays, as it is the same";
}

TEST(ConfigPlan, reducesPicturesForTheTransfer) {
    auto plan = planOfText("compound { viewport [ 0 0 .5 1 ] } compound { channel \"b\" viewport [ .5 0 .5 1 ] "
                           "outputframe { zoom [ .5 .25 ] } }");
    ASSERT_TRUE(plan) << plan.error().message;
    ASSERT_EQ(plan->nodes.size(), 2u);
    EXPECT_TRUE(plan->nodes[0].transferScale.none());
    EXPECT_NEAR(plan->nodes[1].transferScale.x, .5, .005) << "in whole pixels of its channel";
    EXPECT_NEAR(plan->nodes[1].transferScale.y, .25, .005);
    EXPECT_TRUE(plan->nodes[1].pass.zoom.none()) << "it is drawn as it is";
    EXPECT_TRUE(plan->warnings.empty());
    // Ranges composited by depth do not support this.
    auto ranges = planOfText("buffer [ COLOR DEPTH ] compound { range [ 0 .5 ] } compound { channel \"b\" range [ .5 1 "
                             "] outputframe { zoom [ .5 .5 ] } }");
    ASSERT_TRUE(ranges) << ranges.error().message;
    for (const NodePlan& n : ranges->nodes) EXPECT_TRUE(n.transferScale.none());
    ASSERT_EQ(ranges->warnings.size(), 1u);
    EXPECT_NE(ranges->warnings[0].find(".eqc:4:"), std::string::npos) << ranges->warnings[0];
}

TEST(ConfigPlan, showsFramesOfQueuesWhereTheyAreDrawn) {
    const std::string queue = "outputtiles { name \"q\" size [ 16 16 ] } ";
    auto plan = planOfText(queue + "compound { inputtiles { name \"q\" } } compound { channel \"b\" inputtiles { name "
                                   "\"q\" } outputframe { zoom [ .5 .5 ] } }");
    ASSERT_TRUE(plan) << plan.error().message;
    ASSERT_EQ(plan->warnings.size(), 1u);
    EXPECT_NE(plan->warnings[0].find("queue \"q\""), std::string::npos) << plan->warnings[0];
    ASSERT_EQ(plan->nodes.size(), 2u);
    for (const NodePlan& n : plan->nodes) {
        EXPECT_TRUE(n.task.has_value());
        EXPECT_TRUE(n.transferScale.none());
    }
    auto plain = planOfText(
        queue +
        "compound { inputtiles { name \"q\" } } compound { channel \"b\" inputtiles { name \"q\" } outputframe { } }");
    ASSERT_TRUE(plain);
    EXPECT_TRUE(plain->warnings.empty());
}

// Each canvas has its own nodes, which draw the program's picture at its resolution.
TEST(ConfigPlan, showsSeveralCanvases) {
    const SessionPlan plan = planOfFile("wall-and-monitor.eqc");
    ASSERT_EQ(plan.nodes.size(), 3u);
    ASSERT_EQ(plan.canvases.size(), 1u);
    EXPECT_EQ(plan.canvases[0].name, "monitor");
    EXPECT_EQ(plan.canvases[0].shown, (Zoom{.5, .5}));
    EXPECT_EQ(plan.canvases[0].offsetX, 1280) << "beside the wall, where all are on one screen";
    EXPECT_EQ(picturesOf(plan.wall), 2);
    EXPECT_EQ(plan.canvases[0].wall.parts.front().firstPicture, 2) << "behind those of the wall";
    for (const NodePlan& n : plan.nodes) {
        const bool other = n.node == 2;
        EXPECT_EQ(n.canvas, other ? 1 : 0);
        EXPECT_EQ(n.answers, !other) << "programs read the first one's pixels";
        EXPECT_EQ(n.pass.shown, (other ? Zoom{.5, .5} : Zoom{}));
        EXPECT_EQ(n.pass.zoom, n.pass.shown);
        EXPECT_EQ(n.collector, n.node);
        EXPECT_EQ(n.picture, n.node);
    }
    SessionConfig config;
    config.display = Display::Windows;
    EXPECT_TRUE(showsWall(config, plan, plan.nodes[2]));
    EXPECT_FALSE(headShowsCanvas(config, plan.canvases[0]));
    config.display = Display::App;
    EXPECT_TRUE(headShowsCanvas(config, plan.canvases[0])) << "the program has one window";
    config.display = Display::None;
    EXPECT_FALSE(headTakesPictures(config, plan));

    const auto loaded = load("wall-and-monitor.eqc");
    auto named = planOf(loaded, {"me", true, "monitor", {}});
    ASSERT_TRUE(named);
    EXPECT_TRUE(named->canvases.empty()) << "one that is named is shown alone";
    EXPECT_EQ(named->nodes.size(), 1u);
    EXPECT_TRUE(named->nodes[0].pass.shown.none());
}

// A monitor shows the pictures of both channels of the wall as one. No node draws for it.
TEST(ConfigPlan, showsTheWallOnAMonitor) {
    const SessionPlan plan = planOfFile("monitor.eqc");
    EXPECT_TRUE(plan.warnings.empty()) << plan.warnings.front();
    ASSERT_EQ(plan.nodes.size(), 2u);
    EXPECT_TRUE(plan.nodesShowWall);
    ASSERT_EQ(plan.canvases.size(), 1u);
    const CanvasPlan& monitor = plan.canvases[0];
    EXPECT_EQ(monitor.name, "monitor");
    EXPECT_EQ(monitor.shown, (Zoom{.25, .25}));
    EXPECT_EQ(monitor.offsetX, 1920);
    EXPECT_TRUE(monitor.wall.parts.empty());
    ASSERT_EQ(monitor.wall.copies.size(), 1u);
    EXPECT_EQ(monitor.wall.copies[0].canvas, 0);
    EXPECT_TRUE(monitor.wall.copies[0].from.full() && monitor.wall.copies[0].to.full());
    SessionConfig config;
    config.display = Display::Windows;
    EXPECT_TRUE(headShowsCanvas(config, monitor) && headTakesPictures(config, plan));
    EXPECT_TRUE(showsWall(config, plan, plan.nodes[0])) << "the wall's own windows stay";
    for (const NodePlan& n : plan.nodes) EXPECT_FALSE(setupOf(config, plan, n).deepPictures);

    const auto alone = planOf(load("monitor.eqc"), {"me", true, "wall", {}});
    ASSERT_TRUE(alone);
    EXPECT_TRUE(alone->canvases.empty()) << "--canvas shows one alone";
    EXPECT_TRUE(alone->warnings.empty());
}

// A channel of the wall itself can show another one, also without an equalizer: as large as its own area.
TEST(ConfigPlan, showsAChannelOnAnotherOneOfTheSameCanvas) {
    const auto path = ownFile("config_plan_mirror.eqc");
    std::ofstream(path)
        << "#Equalizer 1.2 ascii\nserver { config { appNode { pipe { window { viewport [ 0 0 300 200 ] "
           "channel { name \"a\" } } window { viewport [ 0 0 100 200 ] channel { name \"b\" } } } }\n"
           "layout { view { } } canvas { layout 0 wall { } segment { channel \"a\" viewport [ 0 0 .75 1 "
           "] } segment { channel \"b\" viewport [ .75 0 .25 1 ] } }\n"
           "compound { compound { channel ( segment 0 view 0 ) outputframe { name \"f\" viewport [ 0 0 "
           ".5 1 ] } }\ncompound { channel ( segment 1 view 0 ) inputframe { name \"f\" } } } } }\n";
    const auto loaded =
        compound::loadConfig(path.string(), [](const std::string&) { return std::optional<std::string>(); });
    forget(path);
    ASSERT_TRUE(loaded.ok()) << loaded.diagnostics.firstError();
    const auto plan = planOf(loaded, {"me", true, "", {}});
    ASSERT_TRUE(plan) << plan.error().message;
    ASSERT_EQ(plan->nodes.size(), 1u);
    EXPECT_TRUE(plan->canvases.empty());
    EXPECT_FALSE(plan->nodesShowWall) << "no node has the copy";
    ASSERT_EQ(plan->wall.copies.size(), 1u);
    const PictureCopy& copy = plan->wall.copies[0];
    EXPECT_EQ(copy.canvas, 0);
    EXPECT_NEAR(copy.from.w, .375, 1e-9);
    EXPECT_NEAR(copy.to.x, .75, 1e-9);
    EXPECT_NEAR(copy.to.w, .25, 1e-9);
    EXPECT_EQ(setupOf({}, *plan, plan->nodes[0]).deepPictures, false);
}

TEST(ConfigPlan, showsQuadBufferedPairsOnTheHead) {
    const auto path = ownFile("config_plan_quad.eqc");
    std::ofstream(path) << "#Equalizer 1.2 ascii\nserver { config { appNode { pipe { window { viewport [ 0 0 320 200 ] "
                           "attributes { hint_stereo ON } channel { name \"a\" } } } }\n"
                           "layout { view { mode STEREO } } canvas { layout 0 wall { } segment { channel \"a\" } "
                           "}\ncompound { channel ( ) attributes { stereo_mode QUAD } } } }\n";
    const auto loaded =
        compound::loadConfig(path.string(), [](const std::string&) { return std::optional<std::string>(); });
    forget(path);
    auto plan = planOf(loaded, {"me", true, "", {}});
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_EQ(plan->wall.stereo, StereoMode::Quad);
    EXPECT_TRUE(plan->warnings.empty()) << plan->warnings.front();
    SessionConfig windows;
    windows.display = Display::Windows;
    EXPECT_TRUE(headShowsWall(windows, *plan));
}

TEST(ConfigPlan, plansEveryExampleFile) {
    const auto files = config::testing::exampleFiles();
    if (files.empty())
        GTEST_SKIP() << "no example files at " << config::testing::exampleFolder()
                     << "; MURAL_SHARED says where shared is";
    for (const auto& file : files) {
        const auto loaded =
            compound::loadConfig(file.string(), [](const std::string&) { return std::optional<std::string>(); });
        ASSERT_TRUE(loaded.ok()) << loaded.diagnostics.firstError();
        auto plan = planOf(loaded, {"me", true, "", {}});
        EXPECT_TRUE(plan.ok()) << (plan.ok() ? "" : plan.error().message);
        if (!plan) continue;
        for (const NodePlan& n : plan->nodes) {
            EXPECT_LT(n.picture, n.canvas == 0 ? picturesOf(plan->wall)
                                               : picturesOf(plan->canvases[static_cast<size_t>(n.canvas) - 1].wall))
                << file;
            EXPECT_EQ(n.reach, NodeReach::SharedMemory) << "--all-local";
        }
    }
}

} // namespace
} // namespace mural
