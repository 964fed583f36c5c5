// Delta coding is used for nodes on other machines, not over shared memory.
#include "nodes/head/planning/delta_plan.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

SessionPlan planOf(std::initializer_list<NodeReach> reaches) {
    SessionPlan plan;
    for (const NodeReach reach : reaches) {
        NodePlan node;
        node.node = static_cast<int>(plan.nodes.size());
        node.reach = reach;
        plan.nodes.push_back(node);
    }
    return plan;
}

TEST(DeltaPlan, codesForNetworksButNotForSharedMemory) {
    const SessionPlan plan =
        planOf({NodeReach::SharedMemory, NodeReach::Tcp, NodeReach::LaunchCommand, NodeReach::Tcp});
    const auto third = [](int node) { return node == 3; };
    SessionConfig config;
    EXPECT_EQ(planDelta(config, plan, third).nodes, (std::vector<int>{2, 3}));
    EXPECT_EQ(planDelta(config, plan, [](int) { return false; }).nodes, (std::vector<int>{2}));
    config.delta = DeltaMode::On;
    config.cacheBytes = 64 << 20;
    const DeltaPlan all = planDelta(config, plan, third);
    EXPECT_EQ(all.nodes.size(), 4u);
    EXPECT_NE(all.explain.find("4 nodes"), std::string::npos) << all.explain;
    EXPECT_NE(all.explain.find("64 MiB"), std::string::npos) << all.explain;
    config.delta = DeltaMode::Off;
    EXPECT_TRUE(planDelta(config, plan, third).nodes.empty());
}

} // namespace
} // namespace mural
