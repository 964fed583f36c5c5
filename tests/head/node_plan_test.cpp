#include "nodes/head/node_plan.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

TEST(NodePlan, withoutWishesOneNodePerTileUpToFour) {
    SessionConfig config;
    EXPECT_EQ(planSession(config, "me").nodes.size(), 1u);
    config.columns = 3;
    EXPECT_EQ(planSession(config, "me").nodes.size(), 3u);
    config.rows = 5;
    EXPECT_EQ(planSession(config, "me").nodes.size(), 4u);
}

TEST(NodePlan, hostsAreReachedByTheNearestWay) {
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

TEST(NodePlan, moreNodesThanTilesAreNotStarted) {
    SessionConfig config;
    config.columns = 2;
    config.localNodes = 2;
    config.hosts = {"far"};
    const SessionPlan plan = planSession(config, "me");
    EXPECT_EQ(plan.nodes.size(), 2u);
    ASSERT_EQ(plan.warnings.size(), 1u);
    EXPECT_EQ(plan.warnings[0].rfind("3 render nodes asked for", 0), 0u) << plan.warnings[0];
}

TEST(NodePlan, setupsSayWhatEachNodeDraws) {
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

} // namespace
} // namespace mural
