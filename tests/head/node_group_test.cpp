// New nodes that become members together, or not at all.
#include "nodes/head/membership/node_group.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

TEST(NodeGroup, admitsAllNodesOnceWhenTheLastHasCaughtUp) {
    int admissions = 0;
    NodeGroup group({3, 4}, [&] {
        ++admissions;
        return Result<void>();
    });
    EXPECT_FALSE(group.areAllReady());
    group.ready(3);
    group.ready(3);
    EXPECT_FALSE(group.areAllReady());
    group.ready(4);
    EXPECT_TRUE(group.areAllReady());
    EXPECT_FALSE(*group.caughtUp(3));
    EXPECT_FALSE(*group.caughtUp(3));
    EXPECT_FALSE(group.outcome());
    EXPECT_TRUE(*group.caughtUp(4));
    EXPECT_TRUE(*group.caughtUp(3));
    EXPECT_EQ(admissions, 1);
    group.fail("too late");
    EXPECT_TRUE(group.outcome()->ok());
    EXPECT_FALSE(group.hasFailed());
}

TEST(NodeGroup, keepsTheFirstReasonOfAFailure) {
    NodeGroup group({3, 4}, [] { return Result<void>(Error{"never called"}); });
    EXPECT_FALSE(*group.caughtUp(3));
    group.fail("node 4 is lost");
    group.fail("the change was cancelled");
    ASSERT_TRUE(group.hasFailed());
    EXPECT_EQ(group.outcome()->error().message, "node 4 is lost");
    EXPECT_EQ(group.caughtUp(4).error().message, "node 4 is lost");
}

TEST(NodeGroup, failsIfTheAdmissionFails) {
    NodeGroup group({3}, [] { return Result<void>(Error{"a node was lost meanwhile"}); });
    EXPECT_EQ(group.caughtUp(3).error().message, "a node was lost meanwhile");
    EXPECT_TRUE(group.hasFailed());
}

} // namespace
} // namespace mural
