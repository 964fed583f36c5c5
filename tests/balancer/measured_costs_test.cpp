#include "balancer/simulation/measured_costs.hpp"

#include <numeric>

#include <gtest/gtest.h>

namespace mural::simulation {
namespace {

double sumOf(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(MeasuredCosts, countWorkThatEveryNodeDoesOnce) {
    // Parts of 1, 2, 3 and 4 s, and 5 s that every node needs: one node needs 15 s for the whole frame.
    const MeasuredRuns runs{2, 2, {{7, {15}}}, {{7, {6, 7, 8, 9}}}, {{7, {15, 5}}}};
    const auto trace = costsOf(runs, "app");
    ASSERT_TRUE(trace.ok());
    EXPECT_EQ(trace->name, "app");
    EXPECT_EQ(trace->columns, 2u);
    EXPECT_EQ(trace->rows, 2u);
    EXPECT_EQ(trace->ranges, 2u);
    ASSERT_EQ(trace->frames.size(), 1u);
    const CostFrame& frame = trace->frames.front();
    EXPECT_NEAR(sumOf(frame.cells), 15, 1e-4);
    EXPECT_NEAR(frame.cells[3] / frame.cells[0], 4, 1e-4);
    EXPECT_NEAR(frame.cells[2] / frame.cells[1], 1.5, 1e-4);
    EXPECT_NEAR(frame.ranges[0], 15, 1e-4); // all draws are in the first half
    EXPECT_NEAR(frame.ranges[1], 0, 1e-4);
}

TEST(MeasuredCosts, useOnlyFramesThatAllRunsHave) {
    const MeasuredRuns runs{
        2, 1, {{2, {4}}, {3, {4}}, {4, {4}}}, {{2, {2, 2}}, {3, {1, 3}}, {5, {1, 3}}}, {{3, {2, 2}}, {4, {2, 2}}}};
    const auto trace = costsOf(runs, "app");
    ASSERT_TRUE(trace.ok());
    ASSERT_EQ(trace->frames.size(), 1u);
    EXPECT_NEAR(trace->frames.front().cells[1], 3, 1e-4);
}

// The noise of a run may make the parts smaller than the whole.
TEST(MeasuredCosts, keepTheSumOfAWholeFrame) {
    const MeasuredRuns runs{2, 1, {{2, {4}}}, {{2, {1, 1}}}, {{2, {0, 0}}}};
    const auto trace = costsOf(runs, "app");
    ASSERT_TRUE(trace.ok());
    EXPECT_NEAR(trace->frames.front().cells[0], 2, 1e-4);
    EXPECT_NEAR(trace->frames.front().ranges[1], 2, 1e-4);
}

TEST(MeasuredCosts, keepTheLeastWorkOfSeveralRounds) {
    WorkByFrame least{{2, {3, 5}}, {3, {1, 1}}};
    keepLeastWork(least, {{2, {4, 4}}, {4, {1, 1}}});
    EXPECT_EQ(least, (WorkByFrame{{2, {3, 4}}, {3, {1, 1}}}));
    keepLeastWork(least, {{2, {1}}}); // another number of nodes
    EXPECT_EQ(least.at(2), (std::vector<double>{3, 4}));
}

TEST(MeasuredCosts, areMediansOfNeighbouringFrames) {
    WorkByFrame work;
    for (uint32_t frame = 2; frame < 12; ++frame) work[frame] = {frame < 7 ? 1. : 4., double(frame)};
    work[4][0] = 9; // a disturbance
    work[9][0] = 0;
    smoothOverTime(work, 3);
    for (const auto& [frame, ofNodes] : work) {
        EXPECT_EQ(ofNodes[0], frame < 7 ? 1 : 4) << frame; // the step stays
        EXPECT_EQ(ofNodes[1], frame);                      // so does a slope, at its ends as well
    }
    const WorkByFrame before = work;
    smoothOverTime(work, 1);
    EXPECT_EQ(work, before);
}

TEST(MeasuredCosts, refuseRunsWithoutACommonFrame) {
    const MeasuredRuns apart{1, 2, {{2, {4}}}, {{3, {2, 2}}}, {{2, {2, 2}}}};
    ASSERT_FALSE(costsOf(apart, "app").ok());
    EXPECT_EQ(costsOf(apart, "app").error().message, "the runs have no frame in common");
    const MeasuredRuns idle{1, 2, {{2, {0}}}, {{2, {2, 2}}}, {{2, {2, 2}}}};
    EXPECT_EQ(costsOf(idle, "app").error().message, "frame 2 has no work of a node");
    const MeasuredRuns otherCells{3, 1, {{2, {4}}}, {{2, {2, 2}}}, {{2, {2, 2}}}};
    EXPECT_FALSE(costsOf(otherCells, "app").ok());
}

} // namespace
} // namespace mural::simulation
