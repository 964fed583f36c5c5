// The repairs that a writer sends and their order, without a second copy of data in flight.
#include <gtest/gtest.h>

#include "transport/rsp/protocol/retransmit_planner.hpp"

namespace mural::rsp {
namespace {

constexpr Sequence kFirst{0xffffffe0u}; // the second group begins with 0

SendWindow::Group groupAt(RetransmitPlanner& plan, int number) {
    const SendWindow::Group group{kFirst + number * kMaxInGroup, kMaxInGroup, kMaxInGroup};
    plan.begin(group.base);
    return group;
}

std::optional<RetransmitPlanner::Repair> take(RetransmitPlanner& plan, uint32_t sentUs) {
    return plan.take(kFirst, {}, false, sentUs);
}

TEST(RetransmitPlanner, doesNotResendRowsInFlight) {
    RetransmitPlanner plan(1024);
    const auto group = groupAt(plan, 0);
    plan.want(group, 0b111, 0, 100);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(take(plan, 1000));
    EXPECT_FALSE(take(plan, 1000));
    plan.want(group, 0b111, 0, 500); // reported before the rows can have arrived
    EXPECT_FALSE(take(plan, 1500));
    plan.want(group, 0b111, 1, 1000); // one has arrived, and two are lost
    EXPECT_EQ(take(plan, 1600)->index, 3);
    EXPECT_EQ(take(plan, 1600)->index, 4);
    EXPECT_FALSE(take(plan, 1600));
}

TEST(RetransmitPlanner, doesNotResendRetransmissionsInFlight) {
    RetransmitPlanner plan(1024);
    const auto group = groupAt(plan, 0);
    plan.wantAgain(group, 0b101, 100);
    EXPECT_EQ(take(plan, 1000)->index, 0);
    EXPECT_EQ(take(plan, 1000)->index, 2);
    plan.wantAgain(group, 0b101, 500);
    EXPECT_FALSE(take(plan, 1500));
    plan.wantAgain(group, 0b100, 1000);
    EXPECT_EQ(take(plan, 1600)->index, 2);
}

TEST(RetransmitPlanner, repairsTheOldestGroupFirst) {
    RetransmitPlanner plan(1024);
    std::vector<SendWindow::Group> groups;
    for (int i = 0; i < 5; ++i) groups.push_back(groupAt(plan, i));
    for (const size_t i : {3, 1, 4, 0, 2}) plan.want(groups[i], 1, 0, 100);
    EXPECT_EQ(take(plan, 1000)->base, groups[0].base);
    EXPECT_EQ(take(plan, 1000)->base, groups[1].base);
    plan.want(groups[0], 1, 0, 1000); // lost again: readers wait for it
    EXPECT_EQ(take(plan, 1100)->base, groups[0].base);
    // Groups that all members have are dropped; incomplete groups wait.
    EXPECT_EQ(plan.take(groups[3].base, {}, false, 1100)->base, groups[3].base);
    EXPECT_FALSE(plan.take(groups[3].base, groups[4].base, false, 1100));
    EXPECT_EQ(plan.take(groups[3].base, {}, false, 1100)->base, groups[4].base);
    EXPECT_TRUE(plan.empty() || !take(plan, 1100));
}

} // namespace
} // namespace mural::rsp
