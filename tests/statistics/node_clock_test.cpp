// The clock of a node: round trips of idle and busy nodes, drift.
#include "nodes/head/statistics/node_clock.hpp"

#include <cstdlib>
#include <gtest/gtest.h>
#include <random>

namespace mural {
namespace {

constexpr int64_t kClockMs = 1'000'000;

ClockSample sampleOf(int64_t nowNs, int64_t offsetNs, int64_t thereNs, int64_t backNs) {
    return {nowNs, nowNs + thereNs + offsetNs, nowNs + thereNs + offsetNs, nowNs + thereNs + backNs};
}

TEST(NodeClock, isUnknownWithoutARoundTrip) {
    NodeClock clock;
    EXPECT_FALSE(clock.isKnown());
    clock.addMessage(5, 9);
    EXPECT_FALSE(clock.isKnown());
    EXPECT_EQ(clock.offsetNs(), 0);
}

TEST(NodeClock, needsNoneOnTheHeadsMachine) {
    NodeClock clock = NodeClock::shared();
    clock.addRoundTrip(sampleOf(0, 77, 100, 100));
    EXPECT_TRUE(clock.isKnown());
    EXPECT_EQ(clock.offsetNs(), 0);
    EXPECT_EQ(clock.errorNs(), 0);
}

TEST(NodeClock, keepsTheShortestRoundTripOfABusyNode) {
    NodeClock clock;
    clock.addRoundTrip(sampleOf(0, -5000 * kClockMs, 60'000, 40'000));
    for (int i = 1; i < 500; ++i)
        clock.addRoundTrip(sampleOf(i * 500 * kClockMs, -5000 * kClockMs, 30 * kClockMs, 50'000));
    EXPECT_LE(std::abs(clock.offsetNs() + 5000 * kClockMs), clock.errorNs());
    EXPECT_EQ(clock.errorNs(), 50'000);
}

// A clock that is 50 ppm fast, for ten minutes. The node draws all the time, so each later probe waits in its queue.
TEST(NodeClock, followsTheDriftOfABusyNode) {
    std::mt19937 random(5);
    NodeClock clock;
    const auto offsetAt = [](int64_t ns) { return 123'456'789 + ns / 20'000; };
    const auto backNs = [&] { return 40'000 + static_cast<int64_t>(random() % 400'000); };
    clock.addRoundTrip(sampleOf(0, offsetAt(0), 45'000, 40'000));
    for (int64_t nowNs = 0; nowNs < 600'000 * kClockMs; nowNs += 16 * kClockMs) {
        const int64_t wayNs = backNs();
        clock.addMessage(nowNs + offsetAt(nowNs), nowNs + wayNs);
        if (nowNs % (500 * kClockMs) == 0)
            clock.addRoundTrip(sampleOf(nowNs, offsetAt(nowNs), 16 * kClockMs, backNs()));
        if (nowNs > 2'000 * kClockMs) {
            ASSERT_LE(std::abs(clock.offsetNs() - offsetAt(nowNs)), 150'000) << nowNs;
        }
    }
}

TEST(NodeClock, prefersANewRoundTripThatIsNearlyAsShort) {
    NodeClock clock;
    clock.addRoundTrip(sampleOf(0, 1000, 50'000, 50'000));
    clock.addRoundTrip(sampleOf(100'000 * kClockMs, 900'000, 55'000, 55'000));
    EXPECT_EQ(clock.offsetNs(), 900'000);
}

} // namespace
} // namespace mural
