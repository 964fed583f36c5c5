// The difference between the plan of a running session and another one.
#include "nodes/head/planning/plan_change.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

SessionConfig tiles(int columns, int rows, int ranges = 1) {
    SessionConfig config;
    config.columns = columns;
    config.rows = rows;
    config.passes.ranges = ranges;
    return config;
}

using Numbers = std::vector<int>;

// A session that began with a plan of tiles.
class PlanChangeTest : public testing::Test {
protected:
    void begin(const SessionConfig& with) {
        config = with;
        plan = first = planSession(config, "me");
        numbers = static_cast<int>(plan.nodes.size());
    }
    Result<PlanChange> differenceTo(const SessionConfig& wanted) {
        return changeOf(
            {config, plan, first}, wanted, planSession(wanted, "me"), [this](int node) { return node != lost; },
            numbers);
    }
    // Carries the change out.
    PlanChange changeTo(const SessionConfig& wanted) {
        auto change = differenceTo(wanted);
        EXPECT_TRUE(change.ok());
        config = wanted;
        plan = change->plan;
        numbers = std::max(numbers, static_cast<int>(plan.nodes.size()));
        return *change;
    }

    SessionConfig config;
    SessionPlan plan, first;
    int numbers = 0;
    int lost = -1;
};

TEST_F(PlanChangeTest, keepsNodesWithTheSameTask) {
    begin(tiles(2, 2));
    const PlanChange change = changeTo(tiles(2, 2));
    EXPECT_EQ(change.kept, (Numbers{0, 1, 2, 3}));
    EXPECT_TRUE(change.joining.empty());
    EXPECT_TRUE(change.leaving.empty());
}

TEST_F(PlanChangeTest, replacesALostNodeOfTheSameTask) {
    begin(tiles(2, 1));
    lost = 1;
    const PlanChange change = changeTo(tiles(2, 1));
    EXPECT_EQ(change.kept, Numbers{0});
    EXPECT_EQ(change.joining, Numbers{2});
    EXPECT_EQ(change.leaving, Numbers{1});
}

TEST_F(PlanChangeTest, keepsNodesWhoseTurnAmongTheGpusChanges) {
    SessionConfig with = tiles(6, 1);
    with.hosts = {"wall1", "wall2", "wall1", "wall1", "wall2", "wall2"};
    begin(with);
    with.hosts.front() = "wall2";
    const PlanChange change = changeTo(with);
    EXPECT_EQ(change.kept, (Numbers{1, 2, 3, 4, 5}));
    EXPECT_EQ(change.joining, Numbers{6});
}

TEST_F(PlanChangeTest, neverUsesANumberAgain) {
    begin(tiles(2, 1));
    PlanChange change = changeTo(tiles(3, 1));
    EXPECT_EQ(change.joining, (Numbers{2, 3, 4}));
    EXPECT_EQ(change.leaving, (Numbers{0, 1}));
    EXPECT_TRUE(change.plan.nodes[0].isVacant);
    EXPECT_FALSE(change.plan.nodes[4].isVacant);
    change = changeTo(tiles(2, 1));
    EXPECT_EQ(change.joining, (Numbers{5, 6}));
    EXPECT_EQ(change.leaving, (Numbers{2, 3, 4}));
    for (size_t i = 0; i < change.plan.nodes.size(); ++i) EXPECT_EQ(change.plan.nodes[i].node, static_cast<int>(i));
}

TEST_F(PlanChangeTest, startsNodesAnewThatShareDraws) {
    SessionConfig with = tiles(2, 1, 2);
    with.localNodes = 4;
    begin(with);
    const PlanChange change = changeTo(with);
    EXPECT_TRUE(change.kept.empty());
    ASSERT_EQ(change.joining, (Numbers{4, 5, 6, 7}));
    for (const int node : change.joining) {
        const NodePlan& n = change.plan.nodes[static_cast<size_t>(node)];
        EXPECT_EQ(n.node - n.collector, n.pass.range) << "ranges of a picture have consecutive numbers";
    }
}

TEST_F(PlanChangeTest, givesSetupsOfTheWholeNumbering) {
    begin(tiles(2, 1));
    const SessionConfig wanted = tiles(3, 1);
    const PlanChange change = changeTo(wanted);
    const NodeSetup setup = setupOf(wanted, change.plan, change.plan.nodes[4]);
    EXPECT_EQ(setup.node, 4);
    EXPECT_EQ(setup.nodeCount, 5);
    EXPECT_TRUE(nodeSetupFromJson(toJson(setup)).ok());
}

TEST_F(PlanChangeTest, refusesWindowsForEachEyeLater) {
    begin(tiles(1, 1));
    SessionConfig wanted = tiles(1, 1);
    wanted.passes.stereo = StereoMode::Quad;
    const auto change = differenceTo(wanted);
    ASSERT_FALSE(change.ok());
    EXPECT_NE(change.error().message.find("new session"), std::string::npos) << change.error().message;
}

TEST_F(PlanChangeTest, refusesACanvasThatTheSessionHasNotOpened) {
    begin(tiles(1, 1));
    SessionPlan wanted = plan;
    wanted.canvases.push_back({"second", {}, true, {}, 0});
    const auto change = changeOf(
        {config, plan, first}, config, wanted, [](int) { return true; }, numbers);
    ASSERT_FALSE(change.ok());
    EXPECT_NE(change.error().message.find("\"second\""), std::string::npos) << change.error().message;
}

} // namespace
} // namespace mural
