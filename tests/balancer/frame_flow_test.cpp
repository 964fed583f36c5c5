// The places of draws after viewports and zooms of frames: in numbers, and for random trees compared with a wall of
// single pixels.
#include "balancer/compound/frame_flow.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <set>

#include "balancer/compound/partition.hpp"
#include "balancer/compound/even_split.hpp"
#include "balancer/compound/load_config.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "balancer/config/resolve.hpp"
#include "balancer/config/eqc/parser.hpp"
#include "balancer/config/eqc/writer.hpp"
#include "tests/balancer/symbolic_wall.hpp"
#include "tests/balancer/tree_maker.hpp"
#include "tests/sanitized.hpp"

namespace mural::compound {
namespace {

// The flow of one channel's draws, on a wall of 400 x 200 pixels.
Flow flowOfDraw(const std::string& compounds, const std::string& channel) {
    const std::string text = "#Equalizer 1.2 ascii\nconfig { appNode { pipe { window { viewport [ 0 0 400 200 ] "
                             "channel { name \"d\" } } window { viewport [ 0 0 400 200 ] channel { name \"s\" } } } "
                             "pipe { window { viewport [ 0 0 400 200 ] channel { name \"t\" } } } } layout { view { } "
                             "} canvas { layout 0 wall { } segment { channel \"d\" } } compound { channel ( ) " +
                             compounds + " } }";
    config::Diagnostics diagnostics("f");
    const ResolvedConfig c = config::resolve(config::parseConfig(text, diagnostics), {}, diagnostics);
    EXPECT_EQ(diagnostics.errors(), 0) << diagnostics.firstError();
    const FrameInput input = firstFrame(c);
    const FramePlan plan = planFrame(c, input);
    const auto flows = flowOf(c, input, plan);
    for (const ChannelPlan& one : plan.channels)
        for (const PlannedTask& t : one.tasks)
            if (t.kind == Task::Draw && c.channels[ResolvedConfig::at(one.channel)].name == channel)
                return flows[ResolvedConfig::at(t.context)];
    ADD_FAILURE() << channel << " draws nothing";
    return {};
}

void expectNear(const Viewport& v, double x, double y, double w, double h) {
    EXPECT_NEAR(v.x, x, 1e-9);
    EXPECT_NEAR(v.y, y, 1e-9);
    EXPECT_NEAR(v.w, w, 1e-9);
    EXPECT_NEAR(v.h, h, 1e-9);
}

} // namespace

// "t" belongs to the channel "d", which is on the wall with "m". The monitor "m" shows the upper half of "d".
TEST(FrameFlow, findsCopiesOnOtherDestinations) {
    const std::string text =
        "#Equalizer 1.2 ascii\nconfig { appNode { pipe { window { viewport [ 0 0 400 200 ] channel { name \"d\" } } "
        "window { viewport [ 0 0 100 200 ] channel { name \"m\" } } window { viewport [ 0 0 400 200 ] channel { name "
        "\"t\" } } } } layout { view { } } canvas { layout 0 wall { } segment { channel \"d\" viewport [ 0 0 .5 1 ] } "
        "segment { channel \"m\" viewport [ .5 0 .5 1 ] } } compound { compound { channel ( segment 0 view 0 ) "
        "compound { channel \"t\" viewport [ 0 0 .5 1 ] outputframe { } } inputframe { name \"frame.t\" } compound { "
        "viewport [ .5 0 .5 1 ] } outputframe { name \"up\" viewport [ 0 .5 1 .5 ] } } compound { channel ( segment 1 "
        "view 0 ) inputframe { name \"up\" } } } }";
    config::Diagnostics diagnostics("f");
    const ResolvedConfig c = config::resolve(config::parseConfig(text, diagnostics), {}, diagnostics);
    ASSERT_EQ(diagnostics.errors(), 0) << diagnostics.firstError();
    const FrameInput input = firstFrame(c);
    const FramePlan plan = planFrame(c, input);
    const auto copies = copiesOf(c, input, plan);
    ASSERT_EQ(copies.size(), 2u) << "of t's half and of d's";
    double right = 0;
    for (const ShownCopy& copy : copies) {
        EXPECT_EQ(c.channels[ResolvedConfig::at(copy.channel)].name, "m");
        expectNear(copy.from, 0, .5, 1, .5);
        EXPECT_NEAR(copy.to.w, .5, 1e-9);
        EXPECT_NEAR(copy.to.h, 1, 1e-9);
        right += copy.to.x;
    }
    EXPECT_NEAR(right, .5, 1e-9);
}

TEST(FrameFlow, isTrivialWithoutViewportsAndZooms) {
    EXPECT_FALSE(
        flowOfDraw("compound { channel \"t\" zoom [ .5 .5 ] outputframe { } } inputframe { name \"frame.t\" }", "t")
            .steered);
}

TEST(FrameFlow, clipsToViewportsOfOutputsAndInputs) {
    const Flow f = flowOfDraw("compound { channel \"t\" outputframe { viewport [ .25 0 .5 1 ] } } inputframe { name "
                              "\"frame.t\" viewport [ 0 .5 1 .5 ] }",
                              "t");
    ASSERT_TRUE(f.steered);
    ASSERT_EQ(f.parts.size(), 1u);
    expectNear(f.parts[0].from, .25, .5, .5, .5);
    EXPECT_EQ(f.parts[0].from, f.parts[0].to);
    EXPECT_TRUE(f.parts[0].transferScale.none());
}

TEST(FrameFlow, undoesZoomsOfOutputsWhereTheyAreShown) {
    const Flow f = flowOfDraw("compound { channel \"t\" viewport [ .5 0 .5 1 ] outputframe { zoom [ .5 .25 ] } } "
                              "inputframe { name \"frame.t\" }",
                              "t");
    ASSERT_EQ(f.parts.size(), 1u);
    expectNear(f.parts[0].from, 0, 0, 1, 1);
    expectNear(f.parts[0].to, 0, 0, 1, 1);
    EXPECT_NEAR(f.parts[0].transferScale.x, .5, 1e-9);
    EXPECT_NEAR(f.parts[0].transferScale.y, .25, 1e-9);
}

TEST(FrameFlow, scalesByZoomsOfInputs) {
    const Flow small =
        flowOfDraw("compound { channel \"t\" outputframe { } } inputframe { name \"frame.t\" zoom [ .5 .5 ] }", "t");
    ASSERT_EQ(small.parts.size(), 1u);
    expectNear(small.parts[0].from, 0, 0, 1, 1);
    expectNear(small.parts[0].to, 0, 0, .5, .5);
    EXPECT_TRUE(small.parts[0].transferScale.none()) << "as large as it is shown";
    const Flow large =
        flowOfDraw("compound { channel \"t\" outputframe { } } inputframe { name \"frame.t\" zoom [ 2 2 ] }", "t");
    ASSERT_EQ(large.parts.size(), 1u);
    expectNear(large.parts[0].from, 0, 0, .5, .5);
    expectNear(large.parts[0].to, 0, 0, 1, 1);
    EXPECT_NEAR(large.parts[0].transferScale.x, 1, 1e-9) << "all that was drawn is sent";
}

TEST(FrameFlow, replacesExistingColours) {
    const std::string compounds = "compound { } compound { channel \"t\" outputframe { viewport [ .5 .5 .5 .5 ] } } "
                                  "inputframe { name \"frame.t\" }";
    double area = 0;
    const Flow own = flowOfDraw(compounds, "d"), other = flowOfDraw(compounds, "t");
    for (const ShownPart& p : own.parts) {
        area += p.to.w * p.to.h;
        EXPECT_TRUE(intersect(p.to, Viewport{.5, .5, .5, .5}).empty());
    }
    EXPECT_NEAR(area, .75, 1e-9);
    ASSERT_EQ(other.parts.size(), 1u);
    expectNear(other.parts[0].to, .5, .5, .5, .5);
}

TEST(FrameFlow, recombinesStripesOfDirectSend) {
    const std::string compounds =
        "buffer [ COLOR DEPTH ] "
        "compound { compound { range [ 0 .5 ] outputframe { name \"s2.d\" viewport [ 0 .5 1 .5 ] } } inputframe { name "
        "\"s1.t\" } } "
        "compound { channel \"t\" compound { range [ .5 1 ] outputframe { name \"s1.t\" viewport [ 0 0 1 .5 ] } } "
        "inputframe { name \"s2.d\" } outputframe { name \"s2.t\" buffer [ COLOR ] viewport [ 0 .5 1 .5 ] } } "
        "inputframe { name \"s2.t\" }";
    for (const std::string channel : {"d", "t"}) {
        std::vector<Rect> pieces;
        for (const ShownPart& p : flowOfDraw(compounds, channel).parts) {
            EXPECT_EQ(p.from, p.to);
            pieces.push_back({0, p.to});
        }
        const auto cells = cellsOf(pieces);
        ASSERT_EQ(cells.size(), 1u) << channel;
        expectNear(cells[0].area, 0, 0, 1, 1);
    }
}

TEST(FrameFlow, matchesPixelsOfRandomTrees) {
    size_t compared = 0, steered = 0;
    for (uint64_t seed = 1; seed <= mural::testing::rounds(300); ++seed) {
        const config::ConfigFile file = testing::TreeMaker(seed, true).make();
        const LoadedConfig loaded =
            loadConfig(file, "seed " + std::to_string(seed), [](const std::string&) { return std::nullopt; });
        ASSERT_TRUE(loaded.ok()) << loaded.diagnostics.firstError();
        FrameInput input = firstFrame(loaded.resolved);
        for (input.frameNumber = 0; input.frameNumber < 4; ++input.frameNumber) {
            const FramePlan plan = planFrame(loaded.resolved, input);
            const auto flows = flowOf(loaded.resolved, input, plan);
            testing::SymbolicWall wall(loaded.resolved, input, plan);
            wall.run(); // pixels may stay empty here
            for (auto& [of, pixels] : wall.shown) {
                const auto& [channel, eye] = of;
                const PixelViewport& area = input.sizes.channels[ResolvedConfig::at(channel)];
                for (int32_t y = 0; y < area.h; ++y)
                    for (int32_t x = 0; x < area.w; ++x) {
                        std::set<Index> expected, found;
                        for (const testing::Share& s : pixels[{area.x + x, area.y + y}]) expected.insert(s.context);
                        for (size_t c = 0; c < flows.size(); ++c) {
                            const RenderContext& context = plan.contexts[c];
                            if (!flows[c].steered || context.destination != channel || context.eye != eye) continue;
                            const auto mine = [](const PixelAxis& axis, int32_t pixel) {
                                return (static_cast<int32_t>(std::lround(pixel - axis.origin)) - axis.kernel) %
                                           axis.step ==
                                       0;
                            };
                            if (!mine(context.x, x) || !mine(context.y, y)) continue;
                            const double u = (x + .5 - context.x.origin) / (context.viewport.w * context.x.step),
                                         v = (y + .5 - context.y.origin) / (context.viewport.h * context.y.step);
                            for (const ShownPart& p : flows[c].parts)
                                if (u > p.to.x && u < p.to.x + p.to.w && v > p.to.y && v < p.to.y + p.to.h)
                                    found.insert(static_cast<Index>(c));
                        }
                        if (std::ranges::none_of(flows, &Flow::steered)) continue;
                        ASSERT_EQ(found, expected)
                            << "seed " << seed << " frame " << input.frameNumber << " pixel " << x << " " << y << "\n"
                            << config::writeConfig(file);
                        ++compared;
                    }
            }
            steered += std::ranges::any_of(flows, &Flow::steered);
        }
    }
    EXPECT_GT(compared, mural::testing::rounds(50'000));
    EXPECT_GT(steered, mural::testing::rounds(200));
}

TEST(Cells, areDisjointAndCoverAll) {
    std::mt19937 random(3);
    const auto number = [&](int to) { return static_cast<int>(random() % static_cast<unsigned>(to)); };
    for (int round = 0; round < 200; ++round) {
        std::vector<Rect> pieces;
        for (int i = number(6); i >= 0; --i) {
            const int x = number(16), y = number(16);
            pieces.push_back({number(4), {x / 16., y / 16., (1 + number(16 - x)) / 16., (1 + number(16 - y)) / 16.}});
        }
        const auto cells = cellsOf(pieces);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                const auto holds = [&](const Viewport& v) {
                    return v.x * 16 < x + .5 && (v.x + v.w) * 16 > x + .5 && v.y * 16 < y + .5 &&
                           (v.y + v.h) * 16 > y + .5;
                };
                std::set<int> expected;
                for (const Rect& p : pieces)
                    if (holds(p.area)) expected.insert(p.of);
                int cellsHere = 0;
                std::set<int> found;
                for (const Cell& c : cells)
                    if (holds(c.area)) ++cellsHere, found.insert(c.of.begin(), c.of.end());
                ASSERT_EQ(found, expected);
                ASSERT_EQ(cellsHere, expected.empty() ? 0 : 1);
            }
    }
}

} // namespace mural::compound
