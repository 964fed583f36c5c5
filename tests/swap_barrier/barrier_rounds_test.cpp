// The decisions of a swap barrier: complete rounds, skipped swaps, late and lost members, and random schedules.
#include "nodes/swap_barrier/barrier_rounds.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <set>

namespace mural {
namespace {

constexpr int64_t kPatienceNs = 1000;

SwapKey frame(uint32_t number) { return {1, 2, number}; }

// Returns the members of the only release of a step.
std::vector<int> released(const BarrierRounds::Step& step, const SwapKey& key) {
    if (step.releases.size() != 1 || step.releases[0].key != key) return {-1};
    return step.releases[0].members;
}

TEST(BarrierRounds, releasesAllWhenTheLastArrives) {
    BarrierRounds rounds(3, kPatienceNs);
    EXPECT_TRUE(rounds.arrive(1, frame(1), 1).releases.empty());
    EXPECT_TRUE(rounds.arrive(0, frame(1), 2).releases.empty());
    EXPECT_EQ(released(rounds.arrive(2, frame(1), 3), frame(1)), (std::vector{0, 1, 2}));
    EXPECT_TRUE(rounds.arrive(2, frame(2), 4).releases.empty()); // the next round waits again
}

TEST(BarrierRounds, doesNotWaitForASkippedSwap) {
    BarrierRounds rounds(2, kPatienceNs);
    EXPECT_TRUE(rounds.arrive(0, frame(1), 1).releases.empty());
    EXPECT_EQ(released(rounds.arrive(1, frame(2), 2), frame(1)), std::vector{0}); // member 1 has passed it
    EXPECT_EQ(released(rounds.arrive(0, frame(2), 3), frame(2)), (std::vector{0, 1}));
}

TEST(BarrierRounds, doesNotWaitForALateMemberUntilItReturns) {
    BarrierRounds rounds(3, kPatienceNs);
    (void)rounds.arrive(0, frame(1), 0);
    (void)rounds.arrive(1, frame(1), 10);
    EXPECT_TRUE(rounds.tick(1009).releases.empty());
    const auto step = rounds.tick(1010);
    EXPECT_EQ(step.late, std::vector{2});
    EXPECT_EQ(released(step, frame(1)), (std::vector{0, 1}));
    (void)rounds.arrive(0, frame(2), 1020);
    EXPECT_EQ(released(rounds.arrive(1, frame(2), 1021), frame(2)), (std::vector{0, 1})); // no member waits for it
    EXPECT_EQ(released(rounds.arrive(2, frame(1), 1030), frame(1)), std::vector{2}); // the others have shown this frame
    (void)rounds.arrive(0, frame(3), 1031);
    EXPECT_TRUE(rounds.arrive(1, frame(3), 1032).releases.empty()); // counted again from here
    EXPECT_EQ(released(rounds.arrive(2, frame(2), 1033), frame(2)), std::vector{2});
    EXPECT_EQ(released(rounds.arrive(2, frame(3), 1034), frame(3)), (std::vector{0, 1, 2}));
}

TEST(BarrierRounds, doesNotWaitForALostMember) {
    BarrierRounds rounds(2, kPatienceNs);
    (void)rounds.arrive(0, frame(1), 1);
    EXPECT_EQ(released(rounds.gone(1, 2), frame(1)), std::vector{0});
    EXPECT_EQ(released(rounds.arrive(0, frame(2), 3), frame(2)), std::vector{0});
    EXPECT_TRUE(rounds.arrive(1, frame(2), 4).releases.empty());
    EXPECT_TRUE(rounds.tick(100'000).late.empty());
}

TEST(BarrierRounds, continuesWhenFrameNumbersWrap) {
    BarrierRounds rounds(2, kPatienceNs);
    for (const uint32_t number : {0xffffffffU, 0U, 1U}) {
        (void)rounds.arrive(0, frame(number), 1);
        EXPECT_EQ(released(rounds.arrive(1, frame(number), 2), frame(number)), (std::vector{0, 1})) << number;
    }
}

// Members arrive in random order, skip swaps, are late or die. No member is released twice or before its arrival, all
// live members finish, and a round has all members that wait for its swap.
TEST(BarrierRounds, survivesRandomSchedules) {
    for (unsigned seed = 1; seed <= 300; ++seed) {
        std::mt19937 random(seed);
        const int members = 2 + static_cast<int>(random() % 5);
        constexpr uint32_t kFrames = 30;
        BarrierRounds rounds(members, kPatienceNs);
        // swap at which the member has arrived, or which it has shown
        std::vector<uint32_t> at(static_cast<size_t>(members), 0);
        std::set<int> waiting, dead;
        int64_t nowNs = 0;
        const auto apply = [&](const BarrierRounds::Step& step) {
            for (const auto& release : step.releases)
                for (const int m : release.members) {
                    ASSERT_EQ(waiting.erase(m), 1U) << "seed " << seed;
                    ASSERT_EQ(at[static_cast<size_t>(m)], release.key.frame) << "seed " << seed;
                }
        };
        for (int steps = 0; steps < 5000; ++steps) {
            nowNs += static_cast<int64_t>(random() % 20);
            std::vector<int> free;
            for (int m = 0; m < members; ++m)
                if (!waiting.contains(m) && !dead.contains(m) && at[static_cast<size_t>(m)] < kFrames)
                    free.push_back(m);
            if (free.empty() || random() % 50 == 0) {
                nowNs += kPatienceNs; // absent members are late
                apply(rounds.tick(nowNs));
            } else if (random() % 400 == 0 && static_cast<int>(dead.size()) + 1 < members) {
                const int m = free[random() % free.size()];
                dead.insert(m);
                apply(rounds.gone(m, nowNs));
            } else {
                const int m = free[random() % free.size()];
                uint32_t& own = at[static_cast<size_t>(m)];
                own = std::min(kFrames, own + 1 + (random() % 10 == 0 ? 1U : 0U));
                waiting.insert(m);
                apply(rounds.arrive(m, frame(own), nowNs));
            }
            if (testing::Test::HasFatalFailure()) return;
        }
        // members that have shown all frames do not return
        for (int i = 0; i < 100; ++i) apply(rounds.tick(nowNs += kPatienceNs));
        EXPECT_TRUE(waiting.empty()) << "seed " << seed;
        for (int m = 0; m < members; ++m)
            EXPECT_TRUE(dead.contains(m) || at[static_cast<size_t>(m)] == kFrames) << "seed " << seed;
    }
}

} // namespace
} // namespace mural
