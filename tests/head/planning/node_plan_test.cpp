// The nodes, regions and setups that follow from the options of a session.
#include "nodes/head/planning/make_plan.hpp"

#include <gtest/gtest.h>
#include <set>
#include <tuple>

namespace mural {
namespace {

TEST(NodePlan, startsOneNodePerTileUpToFourByDefault) {
    SessionConfig config;
    EXPECT_EQ(planSession(config, "me").nodes.size(), 1u);
    config.columns = 3;
    EXPECT_EQ(planSession(config, "me").nodes.size(), 3u);
    config.rows = 5;
    EXPECT_EQ(planSession(config, "me").nodes.size(), 4u);
}

TEST(NodePlan, synchronizesWindowsOfSeveralNodes) {
    SessionConfig config;
    config.columns = 3;
    config.display = Display::Windows;
    config.passes.ranges = 2;
    config.localNodes = 6;
    SessionPlan plan = planSession(config, "me");
    ASSERT_EQ(plan.nodes.size(), 6u);
    for (const NodePlan& node : plan.nodes) {
        const NodeSetup setup = setupOf(config, plan, node);
        EXPECT_EQ(setup.swapMembers, node.pass.range == 0 ? 3 : 0) << "only those that have the whole picture show it";
        if (node.pass.range != 0) continue;
        EXPECT_EQ(setup.swapRank, node.node / 2);
        EXPECT_EQ(setup.swapLeader, 0);
        EXPECT_TRUE(setup.swapHere);
    }
    plan.nodes[2].swapBarrier = "another";
    EXPECT_EQ(setupOf(config, plan, plan.nodes[4]).swapMembers, 2);
    EXPECT_EQ(setupOf(config, plan, plan.nodes[4]).swapRank, 1);
    EXPECT_EQ(setupOf(config, plan, plan.nodes[2]).swapMembers, 0) << "alone it waits for nobody";
    plan.nodes[4].reach = NodeReach::LaunchCommand;
    EXPECT_FALSE(setupOf(config, plan, plan.nodes[0]).swapHere);
    config.display = Display::App;
    EXPECT_EQ(setupOf(config, plan, plan.nodes[0]).swapMembers, 0) << "the head shows the picture";
}

TEST(NodePlan, selectsTheNearestTransportPerHost) {
    SessionConfig config;
    config.columns = 5;
    config.localNodes = 1;
    config.hosts = {"localhost", "127.0.0.1", "me", "far"};
    const SessionPlan plan = planSession(config, "me");
    ASSERT_EQ(plan.nodes.size(), 5u);
    EXPECT_EQ(plan.nodes[0].reach, NodeReach::SharedMemory);
    EXPECT_EQ(plan.nodes[1].reach, NodeReach::Tcp);
    EXPECT_EQ(plan.nodes[2].reach, NodeReach::Tcp);
    EXPECT_EQ(plan.nodes[3].reach, NodeReach::Tcp);
    EXPECT_EQ(plan.nodes[4].reach, NodeReach::LaunchCommand);
    EXPECT_TRUE(plan.warnings.empty());
    config.localNodes = 0;
    EXPECT_EQ(planSession(config, "me").nodes.size(), 4u) << "hosts, and no local nodes beside them";
}

TEST(NodePlan, startsNoMoreNodesThanTiles) {
    SessionConfig config;
    config.columns = 2;
    config.localNodes = 2;
    config.hosts = {"far"};
    const SessionPlan plan = planSession(config, "me");
    EXPECT_EQ(plan.nodes.size(), 2u);
    ASSERT_EQ(plan.warnings.size(), 1u);
    EXPECT_EQ(plan.warnings[0].rfind("3 render nodes requested", 0), 0u) << plan.warnings[0];
}

TEST(NodePlan, describesInSetupsWhatEachNodeDraws) {
    SessionConfig config;
    config.columns = 2;
    config.rows = 2;
    config.display = Display::App;
    config.glBackend = "osmesa";
    const SessionPlan plan = planSession(config, "me");
    int tiles = 0;
    for (const NodePlan& node : plan.nodes) {
        const NodeSetup setup = setupOf(config, plan, node);
        EXPECT_EQ(setup.node, node.node);
        EXPECT_EQ(setup.nodeCount, 4);
        EXPECT_TRUE(setup.sendPictures);
        EXPECT_FALSE(setup.wallWindows);
        EXPECT_EQ(setup.glBackend, "osmesa");
        tiles += setup.regionColumns * setup.regionRows;
        EXPECT_TRUE(nodeSetupFromJson(toJson(setup)).ok());
    }
    EXPECT_EQ(tiles, 4);
}

TEST(NodePlan, usesDeepPicturesWhereNothingComputesWithPixels) {
    const auto deep = [](const SessionConfig& config) {
        const SessionPlan plan = planSession(config, "me");
        return setupOf(config, plan, plan.nodes.front()).deepPictures;
    };
    SessionConfig plain;
    plain.columns = 2;
    plain.display = Display::App;
    EXPECT_TRUE(deep(plain));
    SessionConfig other = plain;
    other.codec = "zstd";
    other.passes.ranges = 2;
    EXPECT_TRUE(deep(other));
    other.codec = "jpeg-90";
    EXPECT_FALSE(deep(other));
    other = plain;
    other.display = Display::None;
    other.out = "folder";
    EXPECT_FALSE(deep(other)) << "files have 8 bits";
    other = plain;
    other.passes.samples = 4;
    EXPECT_FALSE(deep(other));
    other = plain;
    other.passes.zoom = {0.5, 0.5};
    EXPECT_FALSE(deep(other));
}

// ---- equalizers

TEST(NodePlan, startsQueuesWithEvenPartsThatMove) {
    SessionConfig config;
    config.tileWidth = config.tileHeight = 32;
    EXPECT_EQ(makePlan(config, "me")->nodes.size(), 4u);
    config.localNodes = 5;
    config.display = Display::Windows;
    const SessionPlan plan = makePlan(config, "me").value();
    ASSERT_EQ(plan.nodes.size(), 5u);
    EXPECT_TRUE(plan.warnings.empty());
    EXPECT_TRUE(headShowsWall(config, plan)) << "windows of nodes could not move";
    int64_t pixels = 0;
    for (const NodePlan& node : plan.nodes) {
        EXPECT_TRUE(node.movesArea);
        EXPECT_FALSE(node.movesRange);
        pixels += apply({0, 0, 1000, 777}, *node.area).area();
        const NodeSetup setup = setupOf(config, plan, node);
        ASSERT_EQ(setup.areas.size(), 20u);
        EXPECT_EQ(setup.areas[static_cast<size_t>(node.node) * 4], node.area->x);
        EXPECT_TRUE(setup.sharesMachine);
        EXPECT_EQ(nodeSetupFromJson(toJson(setup))->areas, setup.areas);
    }
    EXPECT_EQ(pixels, 777'000);
}

TEST(NodePlan, dividesTheGpusOfAMachineAmongItsNodes) {
    SessionConfig config;
    config.columns = 5;
    config.hosts = {"wall1", "wall1", "wall2", "wall1", "wall2"};
    const auto setups = [&] {
        const SessionPlan plan = makePlan(config, "me").value();
        std::vector<NodeSetup> all;
        for (const NodePlan& node : plan.nodes)
            all.push_back(nodeSetupFromJson(toJson(setupOf(config, plan, node))).value());
        return all;
    };
    std::vector<std::pair<int, int>> turns;
    for (const NodeSetup& setup : setups()) turns.emplace_back(setup.gpuTurn, setup.gpuTurns);
    EXPECT_EQ(turns, (std::vector<std::pair<int, int>>{{0, 3}, {1, 3}, {0, 2}, {2, 3}, {1, 2}}));
    config.gpus = {"first"};
    for (const NodeSetup& setup : setups()) EXPECT_EQ(setup.gpuTurns, 1);
    config.gpus = {"1", "GPU-0a"};
    std::vector<std::string> names;
    for (const NodeSetup& setup : setups()) names.push_back(setup.gpu);
    EXPECT_EQ(names, (std::vector<std::string>{"1", "GPU-0a", "1", "1", "GPU-0a"}));
}

TEST(NodePlan, keepsAreasThatCannotMove) {
    const auto planned = [](const auto& change) {
        SessionConfig config;
        config.tileWidth = config.tileHeight = 32;
        config.localNodes = 4;
        change(config);
        const SessionPlan plan = makePlan(config, "me").value();
        for (const NodePlan& node : plan.nodes) EXPECT_EQ(node.movesArea, !setupOf(config, plan, node).areas.empty());
        return std::pair(plan.nodes.front().movesArea, plan.warnings.empty() ? "" : plan.warnings.front());
    };
    EXPECT_TRUE(planned([](SessionConfig&) {}).first);
    EXPECT_TRUE(planned([](SessionConfig& c) { c.passes.stereo = StereoMode::Anaglyph; }).first);
    EXPECT_TRUE(planned([](SessionConfig& c) { c.passes.samples = 2; }).first);
    const auto lean = planned([](SessionConfig& c) { c.tiling = Tiling::Lean; });
    EXPECT_EQ(lean.second,
              "equalizer \"0.queue\": areas stay fixed: --tiling lean gives each node a framebuffer of its "
              "first tiles' size");
    EXPECT_FALSE(lean.first);
    const auto ranges = planned([](SessionConfig& c) { c.passes.ranges = 2; });
    EXPECT_FALSE(ranges.first);
    EXPECT_NE(ranges.second.find("areas stay fixed: its nodes draw ranges (--db)"), std::string::npos) << ranges.second;
    EXPECT_FALSE(planned([](SessionConfig& c) { c.passes.period = 2; }).first);
    EXPECT_FALSE(planned([](SessionConfig& c) { c.passes.kernelWidth = 2; }).first);
    EXPECT_EQ(planned([](SessionConfig& c) { c.localNodes = 1; }), (std::pair(false, std::string())));
}

TEST(NodePlan, sharesEachPassAmongTheNodesOfABalancedSession) {
    const auto nodesOf = [](const auto& change) {
        SessionConfig config;
        config.balance = balance::Balance::Auto;
        change(config);
        const SessionPlan plan = makePlan(config, "me").value();
        int areas = 0, ranges = 0;
        for (const NodePlan& node : plan.nodes) areas += node.movesArea, ranges += node.movesRange;
        return std::tuple(plan.nodes.size(), areas, ranges);
    };
    EXPECT_EQ(nodesOf([](SessionConfig&) {}), std::tuple(4u, 4, 0));
    EXPECT_EQ(nodesOf([](SessionConfig& c) { c.columns = 3; }), std::tuple(3u, 3, 0));
    EXPECT_EQ(nodesOf([](SessionConfig& c) { c.localNodes = 7; }), std::tuple(7u, 7, 0));
    EXPECT_EQ(nodesOf([](SessionConfig& c) { c.passes.ranges = 5; }), std::tuple(5u, 0, 5));
    EXPECT_EQ(nodesOf([](SessionConfig& c) { c.passes.stereo = StereoMode::SideBySide; }), std::tuple(4u, 4, 0));
    EXPECT_EQ(nodesOf([](SessionConfig& c) {
                  c.passes.ranges = 2;
                  c.localNodes = 4;
              }),
              std::tuple(4u, 4, 4))
        << "areas, and the ranges of each";
    SessionConfig hosts;
    hosts.balance = balance::Balance::Load;
    hosts.hosts = {"a", "b"};
    hosts.localNodes = 1;
    const SessionPlan plan = makePlan(hosts, "me").value();
    std::multiset<std::string> places;
    for (const NodePlan& node : plan.nodes) places.insert(node.where);
    EXPECT_EQ(places, (std::multiset<std::string>{"a", "b", "local"}));
}

// ---- passes

TEST(NodePlan, assignsANodeToEveryPassByDefault) {
    SessionConfig config;
    config.passes.samples = 3;
    config.passes.stereo = StereoMode::Anaglyph;
    const SessionPlan plan = planSession(config, "me");
    ASSERT_EQ(plan.nodes.size(), 6u);
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(plan.nodes[static_cast<size_t>(i)].picture, i);
        EXPECT_EQ(plan.nodes[static_cast<size_t>(i)].pass.sample, i % 3);
    }
    EXPECT_TRUE(plan.warnings.empty());
    EXPECT_NE(plan.explain[4].find("right eye, sample 2 of 3"), std::string::npos) << plan.explain[4];
}

TEST(NodePlan, assignsSeveralPassesToFewerHosts) {
    SessionConfig config;
    config.passes.samples = 5;
    config.hosts = {"a", "b"};
    const SessionPlan plan = planSession(config, "me");
    ASSERT_EQ(plan.nodes.size(), 5u);
    for (size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(plan.nodes[i].where, i % 2 ? "b" : "a");
        EXPECT_EQ(plan.nodes[i].reach, NodeReach::LaunchCommand);
    }
}

TEST(NodePlan, dividesTilesOfPassesAmongMoreNodes) {
    SessionConfig config;
    config.passes.stereo = StereoMode::SideBySide;
    config.columns = 2;
    config.rows = 2;
    config.localNodes = 5;
    const SessionPlan plan = planSession(config, "me");
    ASSERT_EQ(plan.nodes.size(), 5u);
    int tiles[2] = {}, nodes[2] = {};
    for (const NodePlan& node : plan.nodes) {
        tiles[node.picture] += node.region.columns * node.region.rows;
        ++nodes[node.picture];
    }
    EXPECT_EQ(tiles[0], 4) << "each pass covers the picture";
    EXPECT_EQ(tiles[1], 4);
    EXPECT_EQ(nodes[0], 3) << "the first has one more";
    EXPECT_EQ(nodes[1], 2);
}

TEST(NodePlan, startsNoMoreNodesThanTilesInPasses) {
    SessionConfig config;
    config.passes.samples = 2;
    config.localNodes = 9;
    config.columns = 2;
    const SessionPlan plan = planSession(config, "me");
    EXPECT_EQ(plan.nodes.size(), 4u);
    EXPECT_EQ(plan.warnings.size(), 1u);
}

TEST(NodePlan, letsOnlyTheFirstPictureAnswer) {
    SessionConfig config;
    config.passes.samples = 2;
    config.passes.period = 2;
    config.columns = 2;
    config.localNodes = 8;
    config.eyeBase = 0.25;
    config.focusDistance = 8;
    const SessionPlan plan = planSession(config, "me");
    ASSERT_EQ(plan.nodes.size(), 8u);
    for (const NodePlan& node : plan.nodes) {
        const NodeSetup setup = setupOf(config, plan, node);
        EXPECT_EQ(setup.answers, node.pass.sample == 0);
        EXPECT_EQ(setup.pass, node.pass);
        EXPECT_EQ(setup.eyeBase, 0.25);
        EXPECT_EQ(setup.focusDistance, 8);
        auto back = nodeSetupFromJson(toJson(setup));
        ASSERT_TRUE(back.ok()) << back.error().message;
        EXPECT_EQ((*back).pass, node.pass);
        EXPECT_EQ((*back).answers, setup.answers);
    }
}

TEST(NodePlan, givesOneOfTheNodesThatShareDrawsTheWindow) {
    SessionConfig config;
    config.passes.ranges = 3;
    config.display = Display::Windows;
    SessionPlan plan = planSession(config, "me");
    ASSERT_EQ(plan.nodes.size(), 3u);
    for (const NodePlan& node : plan.nodes) {
        const NodeSetup setup = setupOf(config, plan, node);
        EXPECT_EQ(setup.wallWindows, node.node == 0);
        EXPECT_EQ(setup.collector, 0);
        EXPECT_TRUE(setup.exchangeHere);
    }
    plan.nodesShowWall = false; // then the head does
    EXPECT_FALSE(setupOf(config, plan, plan.nodes[0]).wallWindows);
}

} // namespace
} // namespace mural
