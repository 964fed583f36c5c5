#include "nodes/head/balancing/part_prediction.hpp"

#include <array>
#include <gtest/gtest.h>

namespace mural {
namespace {

constexpr std::array<int, 2> kNodes = {0, 1};
constexpr std::array<Viewport, 2> kHalves = {{{0, 0, .5, 1}, {.5, 0, .5, 1}}};
constexpr std::array<Viewport, 2> kQuarter = {{{0, 0, .25, 1}, {.25, 0, .75, 1}}};

TEST(PartPrediction, spreadsCostsEvenlyWithinAPart) {
    PartPrediction prediction;
    prediction.measured(0, 0, 8e6);
    prediction.measured(1, 0, 2e6);
    EXPECT_FALSE(prediction.predictedNs(0));
    prediction.moved(kNodes, 1, kHalves, kQuarter);
    EXPECT_DOUBLE_EQ(prediction.predictedNs(0).value(), 4e6);
    EXPECT_DOUBLE_EQ(prediction.predictedNs(1).value(), 2e6 + 4e6);
    EXPECT_FALSE(prediction.measuredNs(0)); // no frame with the new part yet
}

TEST(PartPrediction, ignoresFramesOfEarlierParts) {
    PartPrediction prediction;
    prediction.measured(0, 0, 8e6);
    prediction.measured(1, 0, 2e6);
    prediction.moved(kNodes, 1, kHalves, kQuarter);
    prediction.measured(0, 0, 9e6);
    EXPECT_FALSE(prediction.measuredNs(0));
    prediction.measured(0, 1, 5e6);
    EXPECT_DOUBLE_EQ(prediction.measuredNs(0).value(), 5e6);
    prediction.measured(0, 1, -1); // lost
    EXPECT_DOUBLE_EQ(prediction.measuredNs(0).value(), 5e6);
}

TEST(PartPrediction, leavesNodesWithoutATimeUnknown) {
    PartPrediction prediction;
    prediction.measured(0, 0, 8e6);
    prediction.moved(kNodes, 1, kHalves, kQuarter);
    EXPECT_DOUBLE_EQ(prediction.predictedNs(0).value(), 4e6); // from its own part alone
    EXPECT_FALSE(prediction.predictedNs(1));
}

TEST(PartPrediction, predictsRangesOfDraws) {
    PartPrediction prediction;
    const std::array<Range, 2> before = {{{0, .5}, {.5, 1}}}, after = {{{0, .75}, {.75, 1}}};
    prediction.measured(0, 0, 2e6);
    prediction.measured(1, 0, 8e6);
    prediction.moved(kNodes, 1, before, after);
    EXPECT_DOUBLE_EQ(prediction.predictedNs(0).value(), 6e6);
    EXPECT_DOUBLE_EQ(prediction.predictedNs(1).value(), 4e6);
}

} // namespace
} // namespace mural
