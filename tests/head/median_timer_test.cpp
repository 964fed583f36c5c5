// The typical duration of an operation, robust against outliers.
#include <cstdint>
#include <gtest/gtest.h>

#include "nodes/head/frames/median_timer.hpp"

namespace mural {
namespace {

TEST(MedianTimer, ignoresAnOutlier) {
    MedianTimer time;
    EXPECT_EQ(time.value(), 0);
    time.add(30'000);
    EXPECT_EQ(time.value(), 30'000) << "there is no other";
    time.add(20);
    EXPECT_EQ(time.value(), 20);
    for (const double ns : {22.0, 4e6, 21.0, 5e6, 23.0}) {
        time.add(ns);
        EXPECT_LT(time.value(), 30) << ns;
    }
}

TEST(MedianTimer, isKnownAfterEnoughSamples) {
    MedianTimer time;
    for (const double ns : {4e6, 21.0, 22.0}) {
        EXPECT_FALSE(time.isKnown());
        time.add(ns);
    }
    EXPECT_TRUE(time.isKnown());
    EXPECT_EQ(time.value(), 22);
}

TEST(MedianTimer, separatesSizes) {
    MedianTimersBySize times;
    for (int i = 0; i < 3; ++i) times.of(100).add(5'000);
    EXPECT_TRUE(times.of(127).isKnown());
    EXPECT_EQ(times.of(64).value(), 5'000);
    for (const size_t other : {size_t{0}, size_t{63}, size_t{128}, size_t{77'000}, size_t{1} << 40})
        EXPECT_FALSE(times.of(other).isKnown()) << other;
    times.of(size_t{1} << 40).add(1);
    EXPECT_EQ(times.of(SIZE_MAX).value(), 1);
}

TEST(MedianTimer, followsALastingChange) {
    MedianTimer time;
    for (int i = 0; i < 5; ++i) time.add(20);
    for (int i = 0; i < 3; ++i) time.add(90);
    EXPECT_EQ(time.value(), 90);
}

} // namespace
} // namespace mural
