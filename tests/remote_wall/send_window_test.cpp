// Flow control of a sender of pictures, and the times of its attempts.
#include <gtest/gtest.h>

#include "common/base/clock.hpp"
#include "nodes/remote_wall/retry_times.hpp"
#include "nodes/remote_wall/send_window.hpp"

namespace mural::remote {
namespace {

constexpr int64_t kMs = kNsPerMs;

TEST(SendWindow, holdsTwoFramesInFlight) {
    SendWindow window(60);
    EXPECT_TRUE(window.maySend(0));
    window.sent(1, 100, 0, 0);
    window.sent(2, 100, 20 * kMs, 20 * kMs);
    EXPECT_FALSE(window.maySend(kNsPerS));
    EXPECT_TRUE(window.acknowledge(1, 30 * kMs));
    EXPECT_TRUE(window.maySend(40 * kMs));
    EXPECT_FALSE(window.isIdle());
    EXPECT_TRUE(window.acknowledge(2, 50 * kMs));
    EXPECT_TRUE(window.isIdle());
}

TEST(SendWindow, includesEarlierFramesInAnAcknowledgement) {
    SendWindow window(60);
    window.sent(4, 100, 0, 0);
    window.sent(7, 100, 20 * kMs, 20 * kMs);
    EXPECT_TRUE(window.acknowledge(7, 30 * kMs));
    EXPECT_TRUE(window.isIdle());
    EXPECT_TRUE(window.acknowledge(7, 30 * kMs)); // a repetition
}

TEST(SendWindow, rejectsFramesThatWereNotSent) {
    SendWindow window(60);
    EXPECT_FALSE(window.acknowledge(1, 0));
    window.sent(1, 100, 0, 0);
    EXPECT_FALSE(window.acknowledge(2, 0));
}

TEST(SendWindow, keepsTheLowerRate) {
    SendWindow window(50);
    window.sent(1, 100, 0, 0);
    ASSERT_TRUE(window.acknowledge(1, kMs));
    EXPECT_FALSE(window.maySend(19 * kMs));
    EXPECT_TRUE(window.maySend(20 * kMs));
    window.limitRate(10);
    EXPECT_FALSE(window.maySend(99 * kMs));
    EXPECT_TRUE(window.maySend(100 * kMs));
    window.limitRate(1000);
    EXPECT_EQ(window.nextNs(), 20 * kMs);
}

TEST(SendWindow, measuresTransfersWithoutOverlap) {
    SendWindow window(60);
    window.sent(1, 5000, 10 * kMs, 10 * kMs);
    auto first = window.acknowledge(1, 30 * kMs);
    ASSERT_TRUE(first && *first);
    EXPECT_EQ((*first)->bytes, 5000U);
    EXPECT_EQ((*first)->ns, 20 * kMs);
    window.sent(2, 5000, 40 * kMs, 40 * kMs);
    window.sent(3, 5000, 60 * kMs, 60 * kMs);
    auto second = window.acknowledge(2, 80 * kMs);
    ASSERT_TRUE(second);
    EXPECT_FALSE(*second);
}

TEST(SendWindow, reportsSilence) {
    SendWindow window(60);
    EXPECT_EQ(window.silentNs(kNsPerS), 0);
    window.sent(1, 100, kNsPerS, kNsPerS);
    EXPECT_EQ(window.silentNs(4 * kNsPerS), 3 * kNsPerS);
}

TEST(SendWindow, countsSilenceUntilAnAcknowledgement) {
    SendWindow window(60);
    window.sent(1, 100, 0, 5 * kMs);
    window.sent(2, 100, 20 * kMs, 25 * kMs);
    ASSERT_TRUE(window.acknowledge(1, kNsPerS));
    EXPECT_EQ(window.silentNs(2 * kNsPerS), kNsPerS);
}

TEST(RetryTimes, waitsLongerAfterEachFailure) {
    RetryTimes retry(0);
    EXPECT_EQ(retry.nextNs(), 0);
    for (const int64_t pauseS : {1, 3, 10, 30, 30}) {
        retry.failed(0);
        EXPECT_EQ(retry.nextNs(), pauseS * kNsPerS);
    }
    retry.lost(100 * kNsPerS);
    EXPECT_EQ(retry.nextNs(), 100 * kNsPerS); // at once
}

TEST(RetryTimes, reportsOncePerAbsence) {
    RetryTimes retry(0);
    EXPECT_FALSE(retry.takeReport(9 * kNsPerS, false));
    EXPECT_TRUE(retry.takeReport(10 * kNsPerS, false));
    EXPECT_FALSE(retry.takeReport(20 * kNsPerS, false));
    retry.lost(30 * kNsPerS);
    EXPECT_FALSE(retry.takeReport(31 * kNsPerS, false));
    EXPECT_TRUE(retry.takeReport(31 * kNsPerS, true)); // a wrong secret, for example
}

} // namespace
} // namespace mural::remote
