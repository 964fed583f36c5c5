// Equalizers one by one: invariants of the parts, convergence, damping, freezing, and the rules of each kind.
#include <gtest/gtest.h>
#include <random>

#include "balancer/config/presets.hpp"
#include "balancer/equalizers/dfr_equalizer.hpp"
#include "balancer/equalizers/framerate_equalizer.hpp"
#include "balancer/equalizers/load_equalizer.hpp"
#include "balancer/equalizers/make_equalizers.hpp"
#include "balancer/equalizers/tile_equalizer.hpp"
#include "balancer/equalizers/tree_equalizer.hpp"
#include "balancer/equalizers/view_equalizer.hpp"
#include "tests/balancer/divided_picture.hpp"
#include "tests/sanitized.hpp"

namespace mural::balance {
namespace {

using testing::balanceOf;
using testing::DividedPicture;
using testing::problemOfParts;
using testing::rightHeavy;

constexpr SplitMode kModes[] = {SplitMode::TwoD, SplitMode::Db, SplitMode::Horizontal, SplitMode::Vertical};
constexpr Balance kKinds[] = {Balance::Load, Balance::Tree, Balance::Auto};

std::unique_ptr<Equalizer> make(const DividedPicture& picture, Balance kind) {
    auto all = makeEqualizers(picture.config(), kind);
    EXPECT_EQ(all.size(), 1u);
    return std::move(all.front());
}

double heavy(const LeafStatistics& leaf) { return rightHeavy(leaf, 8); }

TEST(SplitEqualizers, keepPartsInsideDisjointAndCoveringForAnyTimes) {
    std::mt19937 random(5);
    std::uniform_real_distribution<> any(0, 1);
    for (uint64_t round = 0; round < mural::testing::rounds(60); ++round) {
        const SplitMode mode = kModes[round % 4];
        DividedPicture picture(2 + random() % 40, mode);
        const auto equalizer = make(picture, kKinds[round / 4 % 3]);
        for (int f = 0; f < 12; ++f) {
            picture.update(*equalizer);
            ASSERT_EQ(problemOfParts(picture.children(), mode, picture.states()), "") << equalizer->kind() << round;
            equalizer->observe(picture.draw([&](const LeafStatistics&) { return std::pow(any(random), 6); }));
        }
    }
}

TEST(SplitEqualizers, balanceAnUnevenLoad) {
    for (const SplitMode mode : {SplitMode::TwoD, SplitMode::Db, SplitMode::Vertical})
        for (const Balance kind : kKinds) {
            DividedPicture picture(8, mode);
            const auto equalizer = make(picture, kind);
            const double before = balanceOf(picture.draw(heavy), 8);
            picture.run(*equalizer, heavy, 25);
            EXPECT_GT(balanceOf(picture.draw(heavy), 8), std::max(.93, before)) << equalizer->kind() << int(mode);
        }
}

TEST(SplitEqualizers, holdExactlyWhenFrozen) {
    for (const Balance kind : kKinds) {
        DividedPicture picture(8, SplitMode::TwoD);
        const auto equalizer = make(picture, kind);
        picture.run(*equalizer, heavy, 3);
        equalizer->freeze(true, picture.states());
        const States held = picture.states();
        picture.run(
            *equalizer, [](const LeafStatistics& leaf) { return 1 / heavy(leaf); }, 10);
        for (size_t i = 0; i < held.size(); ++i) EXPECT_EQ(picture.states()[i].viewport, held[i].viewport);
        EXPECT_FALSE(equalizer->lastDecision().moved);
        equalizer->freeze(false, picture.states());
        picture.run(*equalizer, heavy, 20);
        EXPECT_GT(balanceOf(picture.draw(heavy), 8), .93);
    }
}

TEST(SplitEqualizers, keepTheirCutsWithDamping1) {
    for (const Balance kind : {Balance::Load, Balance::Tree}) {
        DividedPicture picture(8, SplitMode::TwoD);
        const auto equalizer = make(picture, kind);
        ASSERT_TRUE(equalizer->set("damping", "1").ok());
        const States before = picture.states();
        picture.run(*equalizer, heavy, 10);
        for (size_t i = 0; i < before.size(); ++i) EXPECT_EQ(picture.states()[i].viewport, before[i].viewport);
    }
}

// The reference pulls each cut towards the even split in every frame, so a constant load never becomes balanced.
TEST(LoadEqualizer, dampsTowardsThePreviousSplit) {
    DividedPicture picture(2, SplitMode::Vertical);
    config::LoadEqualizer fields;
    fields.mode = SplitMode::Vertical;
    fields.damping = .8;
    LoadEqualizer equalizer("load", picture.config(), picture.root(), fields);
    picture.run(equalizer, heavy, 60);
    EXPECT_GT(balanceOf(picture.draw(heavy), 2), .99);
}

TEST(LoadEqualizer, snapsToTheBoundaryAndIgnoresMovesBelowTheResistance) {
    DividedPicture picture(4, SplitMode::Vertical);
    config::LoadEqualizer fields;
    fields.mode = SplitMode::Vertical;
    fields.boundary.pixels = config::Pixels2{64, 64};
    LoadEqualizer equalizer("load", picture.config(), picture.root(), fields);
    picture.run(equalizer, heavy, 10);
    for (size_t i = 0; i + 1 < picture.children().size(); ++i) {
        const Viewport v = *picture.states()[at(picture.children()[i])].viewport;
        EXPECT_NEAR(std::remainder((v.x + v.w) * 1920, 64), 0, 1e-6);
        EXPECT_GE(v.w * 1920, 64 - 1e-6);
    }
    ASSERT_TRUE(equalizer.set("resistance", "2000 2000").ok());
    const States held = picture.states();
    picture.run(
        equalizer, [](const LeafStatistics& leaf) { return 1 / heavy(leaf); }, 5);
    for (size_t i = 0; i < held.size(); ++i) EXPECT_EQ(picture.states()[i].viewport, held[i].viewport);
}

TEST(LoadEqualizer, leavesTheDestinationOnlyTheAssemblyAboveTheLimit) {
    DividedPicture picture(4, SplitMode::TwoD);
    config::LoadEqualizer fields;
    fields.assembleOnlyLimit = 3;
    LoadEqualizer equalizer("load", picture.config(), picture.root(), fields);
    picture.run(equalizer, heavy, 3);
    EXPECT_FALSE(picture.states()[at(picture.children()[0])].active);
    EXPECT_EQ(problemOfParts(picture.children(), SplitMode::TwoD, picture.states()), "");
}

TEST(LoadEqualizer, followsTheUsageAndGivesNothingToUsage0) {
    for (const Balance kind : kKinds) {
        DividedPicture picture(4, SplitMode::Db);
        const auto equalizer = make(picture, kind);
        const auto cost = [](const LeafStatistics& leaf) { return leaf.range.end - leaf.range.start; };
        picture.states()[at(picture.children()[1])].usage = 0;
        picture.states()[at(picture.children()[3])].usage = .5;
        picture.run(*equalizer, cost, 20);
        const auto length = [&](size_t i) {
            const Range r = *picture.states()[at(picture.children()[i])].range;
            return r.end - r.start;
        };
        EXPECT_EQ(length(1), 0) << equalizer->kind();
        EXPECT_NEAR(length(0), .4, .03) << equalizer->kind();
        EXPECT_NEAR(length(3), .2, .03) << equalizer->kind();
        picture.states()[at(picture.children()[1])].usage = 1; // comes back
        picture.run(*equalizer, cost, 20);
        EXPECT_NEAR(length(1), 1 / 3.5, .04) << equalizer->kind();
    }
}

TEST(TreeEqualizer, alternatesItsCutsIn2D) {
    DividedPicture picture(8, SplitMode::TwoD);
    const auto equalizer = make(picture, Balance::Tree);
    picture.run(*equalizer, heavy, 5);
    bool hasColumns = false, hasRows = false;
    for (const Index child : picture.children()) {
        hasColumns |= picture.states()[at(child)].viewport->w < .99;
        hasRows |= picture.states()[at(child)].viewport->h < .99;
    }
    EXPECT_TRUE(hasColumns && hasRows);
}

TEST(TreeEqualizer, usesTheHeightForTheResistanceOfRows) {
    DividedPicture picture(2, SplitMode::Horizontal);
    config::TreeEqualizer fields;
    fields.mode = SplitMode::Horizontal;
    fields.resistance.pixels = config::Pixels2{0, 5000};
    TreeEqualizer equalizer("tree", picture.config(), picture.root(), fields);
    const auto low = [](const LeafStatistics& leaf) { return leaf.viewport.y < .1 ? 5. : 1.; };
    picture.run(equalizer, low, 5);
    EXPECT_NEAR(picture.states()[at(picture.children()[0])].viewport->h, .5, 1e-9);
    ASSERT_TRUE(equalizer.set("resistance", "5000 0").ok());
    picture.run(equalizer, low, 5);
    EXPECT_LT(picture.states()[at(picture.children()[0])].viewport->h, .4);
}

// A source that draws with a zoom: its time is in proportion to its pixels.
struct ZoomedSource {
    DividedPicture picture{2, SplitMode::TwoD};
    Index source = picture.children()[1];
    config::DfrEqualizer fields;
    double seconds = 1; // at full resolution
    bool isStill = false;

    FrameStatistics draw() {
        FrameStatistics statistics;
        statistics.frameNumber = picture.input().frameNumber;
        LeafStatistics leaf;
        leaf.compound = source;
        leaf.zoom = picture.states()[at(source)].zoom.value_or(Zoom{});
        leaf.busySeconds = seconds * leaf.zoom.x * leaf.zoom.y;
        statistics.leaves.push_back(leaf);
        statistics.roots.push_back({picture.root(), leaf.busySeconds, isStill});
        return statistics;
    }
};

TEST(DfrEqualizer, holdsTheTargetRateAfterAStepOfTheLoad) {
    for (const size_t latency : {1u, 2u, 3u}) {
        ZoomedSource z;
        z.fields.frameRate = 10;
        DfrEqualizer equalizer("dfr", z.picture.config(), z.source, z.fields);
        std::vector<FrameStatistics> all;
        int good = 0, counted = 0;
        for (int f = 0; f < 120; ++f) {
            z.seconds = f < 40 ? .2 : f < 80 ? .8 : .15;
            z.picture.update(equalizer);
            all.push_back(z.draw());
            if (all.size() >= latency) equalizer.observe(all[all.size() - latency]);
            if (f % 40 < 10) continue;
            ++counted;
            good += std::abs(1 / all.back().roots[0].frameSeconds / 10 - 1) < .1;
        }
        EXPECT_GE(good, counted * 95 / 100) << latency;
    }
}

TEST(DfrEqualizer, showsFullResolutionAtOnceWhenTheProgramStandsStill) {
    ZoomedSource z;
    DfrEqualizer equalizer("dfr", z.picture.config(), z.source, z.fields);
    for (int f = 0; f < 20; ++f) {
        z.picture.update(equalizer);
        equalizer.observe(z.draw());
    }
    const Zoom moving = *z.picture.states()[at(z.source)].zoom;
    EXPECT_LT(moving.x, .5);
    z.isStill = true;
    equalizer.observe(z.draw());
    z.picture.update(equalizer);
    EXPECT_EQ(*z.picture.states()[at(z.source)].zoom, (Zoom{1, 1}));
    z.isStill = false;
    FrameStatistics moves = z.draw();
    moves.leaves[0].zoom = moving;
    moves.roots[0].frameSeconds = .1;
    equalizer.observe(moves);
    z.picture.update(equalizer);
    EXPECT_NEAR(z.picture.states()[at(z.source)].zoom->x, moving.x, .02);
}

TEST(DfrEqualizer, neverDrawsFewerThan128Pixels) {
    ZoomedSource z;
    z.seconds = 1e6;
    DfrEqualizer equalizer("dfr", z.picture.config(), z.source, z.fields);
    for (int f = 0; f < 60; ++f) {
        z.picture.update(equalizer);
        equalizer.observe(z.draw());
    }
    EXPECT_NEAR(z.picture.states()[at(z.source)].zoom->y * 1080, 128, 1);
}

TEST(DfrEqualizer, staysAboveTheMinimum) {
    ZoomedSource z;
    z.seconds = 1e6;
    z.fields.minimum = .6;
    DfrEqualizer equalizer("dfr", z.picture.config(), z.source, z.fields);
    const auto zoomAfter = [&](int frames) {
        for (int f = 0; f < frames; ++f) {
            z.picture.update(equalizer);
            equalizer.observe(z.draw());
        }
        return z.picture.states()[at(z.source)].zoom->x;
    };
    EXPECT_NEAR(zoomAfter(60), .6, 1e-6);
    ASSERT_TRUE(equalizer.set("minimum", "0.3").ok());
    EXPECT_NEAR(zoomAfter(60), .3, 1e-6);
}

// A zoom of the file, here or above, is full resolution.
TEST(DfrEqualizer, neverExceedsTheZoomOfTheFile) {
    ZoomedSource z;
    config::ResolvedConfig config = z.picture.config();
    config.compounds[at(z.picture.root())].zoom = {.5, .5};
    config.compounds[at(z.source)].zoom = {.5, .5};
    DfrEqualizer equalizer("dfr", config, z.source, z.fields);
    EXPECT_EQ(equalizer.targets(config), std::vector<Index>{z.source});
    const auto after = [&](double seconds, double zoom) {
        FrameStatistics statistics = z.draw();
        statistics.leaves[0].zoom = {.25 * zoom, .25 * zoom};
        statistics.roots[0].frameSeconds = seconds;
        equalizer.observe(statistics);
        const FrameContext context{config, z.picture.input()};
        States states = z.picture.states();
        equalizer.update(context, states);
        return states[at(z.source)].zoom.value_or(Zoom{.5, .5});
    };
    EXPECT_EQ(after(.001, 1), (Zoom{.5, .5}));
    ASSERT_TRUE(equalizer.set("damping", "1").ok());
    EXPECT_NEAR(after(.2, 1).x, .5 * std::sqrt(.5), 1e-9);
    EXPECT_NEAR(after(.1, std::sqrt(.5)).x, .5 * std::sqrt(.5), 1e-9);
    EXPECT_EQ(after(.001, std::sqrt(.5)), (Zoom{.5, .5}));
}

compound::LoadedConfig presetOf(const config::Preset& form) {
    const auto file = config::shortForm(form);
    EXPECT_TRUE(file.ok());
    return compound::loadConfig(file.value(), "preset", [](const std::string&) { return std::nullopt; });
}

TEST(FramerateEqualizer, pacesTheSlowestOfFramesInTurn) {
    config::Preset form;
    form.frames = 3;
    const auto loaded = presetOf(form);
    auto all = makeEqualizers(loaded.resolved);
    ASSERT_EQ(all.size(), 1u);
    compound::FrameInput input = compound::firstFrame(loaded.resolved);
    const auto& children = loaded.resolved.compounds[at(all[0]->compound())].children;
    for (uint64_t f = 0; f < 30; ++f) {
        input.frameNumber = f;
        all[0]->update({loaded.resolved, input}, input.compounds);
        FrameStatistics statistics;
        statistics.frameNumber = f;
        LeafStatistics leaf;
        leaf.compound = children[f % 3];
        leaf.busySeconds = f % 3 == 1 ? .3 : .2;
        statistics.leaves.push_back(leaf);
        all[0]->observe(statistics);
    }
    all[0]->update({loaded.resolved, input}, input.compounds);
    EXPECT_NEAR(input.compounds[at(all[0]->compound())].maxFps, 10 * 1.05, .01); // 3 frames per .3 s
    EXPECT_NEAR(input.compounds[at(children[0])].maxFps, 3.5, .01);
}

TEST(TileEqualizer, movesTilesAndChunksToFasterChannels) {
    for (const bool isChunks : {false, true}) {
        config::Preset form;
        if (isChunks) {
            form.ranges = 4;
            form.chunks = 64;
        } else {
            form.takers = 4;
            form.tileWidth = form.tileHeight = 64;
        }
        const auto loaded = presetOf(form);
        auto all = makeEqualizers(loaded.resolved);
        ASSERT_EQ(all.size(), 1u);
        auto* tiles = dynamic_cast<TileEqualizer*>(all[0].get());
        ASSERT_NE(tiles, nullptr);
        compound::FrameInput input = compound::firstFrame(loaded.resolved);
        double balance = 0;
        for (int f = 0; f < 60; ++f) {
            tiles->update({loaded.resolved, input}, input.compounds);
            FrameStatistics statistics;
            for (const Index taker : tiles->takers()) {
                LeafStatistics leaf;
                leaf.compound = taker;
                leaf.viewport = input.compounds[at(taker)].viewport.value_or(Viewport{});
                leaf.range = input.compounds[at(taker)].range.value_or(Range{});
                leaf.busySeconds = heavy(leaf);
                statistics.leaves.push_back(leaf);
            }
            balance = balanceOf(statistics, 4);
            tiles->observe(statistics);
        }
        EXPECT_GT(balance, .85) << isChunks;
        EXPECT_EQ(problemOfParts(tiles->takers(), isChunks ? SplitMode::Db : SplitMode::TwoD, input.compounds), "");
    }
}

} // namespace
} // namespace mural::balance
