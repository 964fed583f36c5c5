// Clocks with an offset and paths with different delays: the offset is as accurate as the shortest path permits.
#include "nodes/swap_barrier/clock_offset.hpp"

#include <cstdlib>
#include <gtest/gtest.h>
#include <random>

namespace mural {
namespace {

// Returns a sample in which the other clock is ahead by `offset`. The paths take `thereNs` and `backNs`, and the other
// end delays its reply by `heldNs`.
ClockSample sampleOf(int64_t nowNs, int64_t offset, int64_t thereNs, int64_t heldNs, int64_t backNs) {
    return {nowNs, nowNs + thereNs + offset, nowNs + thereNs + heldNs + offset, nowNs + thereNs + heldNs + backNs};
}

TEST(ClockOffset, isExactForSymmetricPaths) {
    ClockOffset clock;
    EXPECT_EQ(clock.errorNs(), INT64_MAX);
    clock.add(sampleOf(1'000'000, -5'000'000'000, 100, 77'000'000, 100));
    EXPECT_EQ(clock.offsetNs(), -5'000'000'000);
    EXPECT_EQ(clock.errorNs(), 100);
}

TEST(ClockOffset, staysWithinItsReportedError) {
    std::mt19937_64 random(3);
    for (int round = 0; round < 200; ++round) {
        ClockOffset clock;
        const auto offset = static_cast<int64_t>(random() % 2'000'000'000'000) - 1'000'000'000'000;
        int64_t nowNs = 0;
        for (int i = 0; i < 100; ++i) {
            nowNs += static_cast<int64_t>(random() % 20'000'000);
            const auto way = [&] {
                return static_cast<int64_t>(20'000 + random() % (i % 7 == 0 ? 10'000'000 : 200'000));
            };
            clock.add(sampleOf(nowNs, offset, way(), static_cast<int64_t>(random() % 30'000'000), way()));
            EXPECT_LE(std::abs(clock.offsetNs() - offset), clock.errorNs());
        }
        EXPECT_LT(clock.errorNs(), 200'000);
    }
}

TEST(ClockOffset, rejectsRepliesFromBeforeTheRequest) {
    ClockOffset clock;
    clock.add({1000, 5000, 9000, 1500}); // delay longer than the whole round trip
    EXPECT_EQ(clock.errorNs(), INT64_MAX);
}

TEST(ClockOffset, followsADriftingClock) {
    ClockOffset clock;
    for (int i = 0; i < 1000; ++i)
        clock.add(sampleOf(i * 16'000'000LL, i * 1600LL, 50'000, 1'000'000, 50'000)); // 100 us per s
    EXPECT_NEAR(static_cast<double>(clock.offsetNs()), 999 * 1600.0, 64 * 1600.0);
}

} // namespace
} // namespace mural
