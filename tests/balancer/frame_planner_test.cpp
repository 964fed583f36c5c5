// The planner's loop: differences between plans, and equality with the plan of a single frame.
#include <gtest/gtest.h>

#include "balancer/compound/plan_frame.hpp"
#include "balancer/equalizers/make_equalizers.hpp"
#include "tests/balancer/divided_picture.hpp"

namespace mural::balance {
namespace {

using Kind = ContextChange::Kind;

FramePlanner plannerOf(const ResolvedConfig& config, Balance balance) {
    return FramePlanner(config, compound::firstFrame(config), makeEqualizers(config, balance));
}

FrameStatistics drawn(const FramePlanner& planner, FramePlanner& mutablePlanner, double right) {
    FrameStatistics statistics;
    statistics.frameNumber = planner.plan().frameNumber;
    for (const auto& channel : planner.plan().channels)
        for (const auto& task : channel.tasks) {
            if (task.kind != config::Task::Draw) continue;
            LeafStatistics leaf = leafOf(planner.plan().contexts[at(task.context)], mutablePlanner.input().sizes);
            leaf.busySeconds = testing::rightHeavy(leaf, right);
            statistics.leaves.push_back(leaf);
        }
    return statistics;
}

TEST(FramePlanner, reportsAllContextsFirstAndThenOnlyChanges) {
    const auto loaded = simulation::dividedConfig(6, config::SplitMode::TwoD);
    FramePlanner planner = plannerOf(loaded.resolved, Balance::Auto);
    const size_t first = planner.next().changes.size();
    EXPECT_EQ(first, planner.plan().contexts.size());
    EXPECT_TRUE(planner.next().empty());
    planner.addStatistics(drawn(planner, planner, 20));
    const FrameChange& change = planner.next();
    EXPECT_FALSE(change.empty());
    EXPECT_EQ(change.frame, 2u);
    for (const ContextChange& c : change.changes) {
        EXPECT_EQ(c.kind, Kind::Changed);
        EXPECT_EQ(planner.plan().contexts[at(c.context)].compound, c.compound);
    }
    planner.changeInput().compounds[at(loaded.resolved.roots.front()) + 3].active = false;
    bool hasVanished = false;
    for (const ContextChange& c : planner.next().changes) hasVanished |= c.kind == Kind::Vanished;
    EXPECT_TRUE(hasVanished);
}

TEST(FramePlanner, givesTheSamePlanAsASingleFrame) {
    const auto loaded = simulation::dividedConfig(9, config::SplitMode::TwoD);
    FramePlanner planner = plannerOf(loaded.resolved, Balance::Load);
    for (int f = 0; f < 20; ++f) {
        planner.next();
        compound::FrameInput input = planner.input();
        input.frameNumber = planner.plan().frameNumber;
        const compound::FramePlan plan = compound::planFrame(loaded.resolved, input);
        ASSERT_EQ(plan.contexts.size(), planner.plan().contexts.size());
        for (size_t i = 0; i < plan.contexts.size(); ++i) {
            EXPECT_EQ(plan.contexts[i].viewport, planner.plan().contexts[i].viewport);
            EXPECT_EQ(plan.contexts[i].area, planner.plan().contexts[i].area);
            EXPECT_EQ(plan.contexts[i].taskId, planner.plan().contexts[i].taskId);
        }
        planner.addStatistics(drawn(planner, planner, f % 7 + 1));
    }
}

TEST(FramePlanner, findsEqualizersById) {
    const auto loaded = simulation::dividedConfig(4, config::SplitMode::Db);
    FramePlanner planner = plannerOf(loaded.resolved, Balance::AsInFile);
    ASSERT_EQ(planner.equalizers().size(), 1u);
    EXPECT_EQ(planner.find(planner.equalizers()[0]->id()), planner.equalizers()[0].get());
    EXPECT_EQ(planner.find("other"), nullptr);
}

} // namespace
} // namespace mural::balance
