// The time that a batch job has left, and the notices about it.
#include "nodes/launch/launchers/job_clock.hpp"

#include <gtest/gtest.h>
#include <poll.h>

#include "common/base/clock.hpp"
#include "nodes/head/membership/job_deadline.hpp"

namespace mural {
namespace {

constexpr int64_t kReplyPatienceMs = 20'000;

TEST(JobClock, readsTheTextsOfSlurm) {
    EXPECT_EQ(launch::timeIn("1764636000"), 1'764'636'000);
    for (const char* text :
         {"", "0", "-5", "NONE", "N/A", "Unknown", "2026-12-02T03:55:15", "1764636000 ", "99999999999999"})
        EXPECT_EQ(launch::timeIn(text), std::nullopt) << text;
}

// Returns the end after the first reply of the command.
std::optional<int64_t> endOf(const std::string& script) {
    const launch::JobClock clock({"sh", "-c", script}, 10);
    const Deadline deadline = Deadline::inMs(kReplyPatienceMs);
    while (!clock.endNs() && !deadline.passed()) poll(nullptr, 0, 5);
    return clock.endNs();
}

TEST(JobClock, asksItsCommand) {
    const int64_t before = monotonicNowNs();
    const auto end = endOf("date -d +10min +%s");
    ASSERT_TRUE(end);
    EXPECT_GE(*end, before + 598 * kNsPerS); // whole seconds
    EXPECT_LE(*end, monotonicNowNs() + 601 * kNsPerS);
}

TEST(JobClock, keepsItsReplyWhenTheCommandFails) {
    const std::string mark = testing::TempDir() + "asked." + std::to_string(getpid());
    const launch::JobClock clock({"sh", "-c", "[ -e " + mark + " ] && exit 1; touch " + mark + "; date -d +10min +%s"},
                                 5);
    const Deadline deadline = Deadline::inMs(kReplyPatienceMs);
    while (!clock.endNs() && !deadline.passed()) poll(nullptr, 0, 5);
    poll(nullptr, 0, 200);
    EXPECT_TRUE(clock.endNs());
    unlink(mark.c_str());
}

TEST(JobClock, endsWhileItsCommandHangs) {
    const int64_t before = monotonicNowNs();
    {
        const launch::JobClock clock({"sleep", "100"});
        poll(nullptr, 0, 50);
    }
    EXPECT_LT(monotonicNowNs() - before, 5 * kNsPerS);
}

constexpr int64_t kJobBegin = 1'000 * kNsPerS;
int64_t afterS(int64_t seconds) { return kJobBegin + seconds * kNsPerS; }

TEST(JobDeadline, warnsAtFiveMinutesAndOneMinuteAndEndsInTime) {
    JobDeadline deadline("12");
    const int64_t end = afterS(1000);
    EXPECT_FALSE(deadline.check(end, afterS(699)));
    const auto first = deadline.check(end, afterS(701));
    ASSERT_TRUE(first);
    EXPECT_EQ(first->line, "Slurm job 12 ends in 4 min 59 s; an operator can extend it: scontrol update JobId=12 "
                           "TimeLimit=+60");
    EXPECT_FALSE(first->isOver);
    EXPECT_FALSE(deadline.check(end, afterS(702)));
    EXPECT_EQ(deadline.check(end, afterS(945)).value().line.rfind("Slurm job 12 ends in 55 s;", 0), 0U);
    const auto last = deadline.check(end, afterS(991));
    ASSERT_TRUE(last);
    EXPECT_TRUE(last->isOver);
    EXPECT_EQ(last->line, "Slurm job 12 ends in 9 s: the run ends now, so that its files are complete");
    EXPECT_FALSE(deadline.check(end, afterS(995)));
}

TEST(JobDeadline, followsChangedLimits) {
    JobDeadline deadline("12");
    EXPECT_FALSE(deadline.check(std::nullopt, afterS(0)));
    EXPECT_TRUE(deadline.check(afterS(200), afterS(0)));
    EXPECT_FALSE(deadline.check(afterS(4000), afterS(1))); // extended
    EXPECT_FALSE(deadline.check(std::nullopt, afterS(2)));
    EXPECT_TRUE(deadline.check(afterS(4000), afterS(3750)));
}

} // namespace
} // namespace mural
