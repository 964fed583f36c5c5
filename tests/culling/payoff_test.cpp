#include "nodes/culling/payoff.hpp"

#include <gtest/gtest.h>

namespace mural::culling {
namespace {

uint32_t pauseAfter(Payoff& payoff) {
    for (uint32_t i = 0; i < kVainAttempts; ++i) {
        EXPECT_FALSE(payoff.isPaused());
        payoff.tried(false);
    }
    uint32_t draws = 0;
    for (; payoff.isPaused(); ++draws) payoff.skip();
    return draws;
}

TEST(Payoff, doublesThePauseUpToALimit) {
    Payoff payoff;
    uint32_t expected = kLeastPause;
    for (int i = 0; i < 10; ++i, expected = std::min(2 * expected, kLongestPause))
        EXPECT_EQ(pauseAfter(payoff), expected);
}

TEST(Payoff, beginsAnewAfterASuccess) {
    Payoff payoff;
    (void)pauseAfter(payoff);
    (void)pauseAfter(payoff);
    payoff.tried(true);
    EXPECT_EQ(pauseAfter(payoff), kLeastPause);
    for (int i = 0; i < 100; ++i) {
        payoff.tried(i % 7 == 0);
        EXPECT_FALSE(payoff.isPaused());
    }
}

} // namespace
} // namespace mural::culling
