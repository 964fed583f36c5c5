// Limits that count only while the processes involved run.
#include <gtest/gtest.h>

#include "common/clock.hpp"
#include "common/running_time.hpp"

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
        for (int64_t slice = 0; slice < 20; ++slice) countedNs = waited.countNs(second * kNsPerS + slice * kStepNs, static_cast<uint32_t>(second));
    EXPECT_EQ(countedNs, 60 * kNsPerS);
}

} // namespace
} // namespace mural
