// Limits that count only while the processes involved run.
#include <gtest/gtest.h>

#include "common/base/clock.hpp"
#include "common/base/running_time.hpp"

namespace mural {
namespace {

constexpr int64_t kStepNs = 50 * kNsPerMs;

TEST(RunningTime, countsWhileBothRun) {
    RunningTime waited(0, 7);
    uint32_t beat = 7;
    for (int64_t nowNs = kStepNs; nowNs <= kNsPerS; nowNs += kStepNs) EXPECT_EQ(waited.countNs(nowNs, ++beat), nowNs);
}

TEST(RunningTime, doesNotCountWhileTheOtherProcessIsStopped) {
    RunningTime waited(0, 7);
    for (int64_t nowNs = 0; nowNs < 100 * kNsPerS; nowNs += kStepNs) EXPECT_EQ(waited.countNs(nowNs, 7), 0);
    EXPECT_LE(waited.countNs(100 * kNsPerS, 8), RunningTime::kMaxGapNs);
}

TEST(RunningTime, countsLittleOfATimeInWhichTheCallerWasStopped) {
    RunningTime waited(0);
    EXPECT_EQ(waited.countNs(kStepNs), kStepNs);
    EXPECT_EQ(waited.countNs(1000 * kNsPerS), kStepNs + RunningTime::kMaxGapNs);
    EXPECT_EQ(waited.countNs(1000 * kNsPerS + kStepNs), 2 * kStepNs + RunningTime::kMaxGapNs);
}

TEST(RunningTime, countsALongWaitOfRareBeats) {
    RunningTime waited(0, 0);
    int64_t countedNs = 0;
    for (int64_t second = 1; second <= 60; ++second)
        for (int64_t slice = 0; slice < 20; ++slice)
            countedNs = waited.countNs(second * kNsPerS + slice * kStepNs, static_cast<uint32_t>(second));
    EXPECT_EQ(countedNs, 60 * kNsPerS);
}

// The watch of a process reports its pauses. Here the test takes the place of the watch.
class Pauses : public ::testing::Test {
protected:
    void SetUp() override { pauses::tick(nowNs_); }
    void TearDown() override { pauses::endWatch(); }
    void runs(int64_t forNs) {
        for (const int64_t endNs = nowNs_ + forNs; nowNs_ < endNs;) pauses::tick(nowNs_ += pauses::kTickNs);
    }
    int64_t nowNs_ = monotonicNowNs();
    const int64_t beforeNs_ = pauses::totalNs(nowNs_);
};

TEST_F(Pauses, areNoneWhileTheWatchTicks) {
    runs(20 * kNsPerS);
    EXPECT_EQ(pauses::totalNs(nowNs_) - beforeNs_, 0);
}

TEST_F(Pauses, areSeenBeforeAndAfterTheWatchRunsAgain) {
    runs(kNsPerS);
    nowNs_ += 45 * kNsPerS;
    const int64_t early = pauses::totalNs(nowNs_) - beforeNs_;
    pauses::tick(nowNs_);
    const int64_t late = pauses::totalNs(nowNs_) - beforeNs_;
    EXPECT_EQ(early, late);
    EXPECT_NEAR(static_cast<double>(late), static_cast<double>(45 * kNsPerS), static_cast<double>(pauses::kTickNs));
}

TEST_F(Pauses, doNotShortenADeadline) {
    runs(kNsPerS);
    const Deadline deadline = Deadline::at(nowNs_ + 10 * kNsPerS);
    EXPECT_NEAR(static_cast<double>(deadline.atNs()), static_cast<double>(nowNs_ + 10 * kNsPerS), 1);
    nowNs_ += 45 * kNsPerS;
    pauses::tick(nowNs_);
    EXPECT_NEAR(static_cast<double>(deadline.atNs()), static_cast<double>(nowNs_ + 10 * kNsPerS),
                static_cast<double>(pauses::kTickNs));
}

} // namespace
} // namespace mural
