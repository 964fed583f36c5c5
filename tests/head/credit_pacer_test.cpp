// The times at which programs receive credit.
#include "nodes/head/frames/credit_pacer.hpp"

#include <chrono>
#include <condition_variable>
#include <gtest/gtest.h>
#include <mutex>
#include <vector>

#include "common/base/clock.hpp"

namespace mural {
namespace {

TEST(PacedCredit, hasAllFinishedFramesWithoutAnInterval) {
    PacedCredit credit;
    credit.add(5);
    EXPECT_EQ(credit.at(1), 5u);
    EXPECT_FALSE(credit.nextNs());
}

TEST(PacedCredit, growsByOneFramePerInterval) {
    PacedCredit credit;
    credit.setInterval(100, 1000);
    credit.add(3);
    EXPECT_EQ(credit.at(1000), 1u);
    EXPECT_EQ(credit.nextNs(), 1100);
    EXPECT_EQ(credit.at(1099), 1u);
    EXPECT_EQ(credit.at(1100), 2u);
    EXPECT_EQ(credit.at(1200), 3u);
    EXPECT_FALSE(credit.nextNs()) << "no finished frame is left";
}

TEST(PacedCredit, givesASlowProgramItsFramesAtOnce) {
    PacedCredit credit;
    credit.setInterval(100, 0);
    for (uint32_t frame = 1; frame < 10; ++frame) {
        credit.add(frame);
        EXPECT_EQ(credit.at(frame * 150), frame);
    }
}

TEST(PacedCredit, givesEverythingWhenThePaceEnds) {
    PacedCredit credit;
    credit.setInterval(100, 0);
    credit.add(7);
    EXPECT_EQ(credit.at(0), 1u);
    credit.setInterval(0, 10);
    EXPECT_EQ(credit.at(10), 7u);
}

TEST(PacedCredit, takesAShorterIntervalOverAtOnce) {
    PacedCredit credit;
    credit.setInterval(1000, 0);
    credit.add(3);
    EXPECT_EQ(credit.at(0), 1u);
    credit.setInterval(10, 5);
    EXPECT_EQ(credit.at(15), 2u);
}

struct Sent {
    uint32_t client, finished, shown;
    int64_t atNs;
};

class CreditPacerTest : public ::testing::Test {
protected:
    std::vector<Sent> waitFor(size_t count) {
        std::unique_lock lock(mutex_);
        EXPECT_TRUE(changed_.wait_for(lock, std::chrono::seconds(10), [&] { return sent_.size() >= count; }));
        return sent_;
    }

    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::vector<Sent> sent_;
    CreditPacer pacer_{[this](uint32_t client, uint32_t finished, uint32_t shown) {
        const std::lock_guard lock(mutex_);
        sent_.push_back({client, finished, shown, monotonicNowNs()});
        changed_.notify_all();
    }};
};

TEST_F(CreditPacerTest, spacesABurstOfFrames) {
    constexpr double kPace = 50;
    constexpr int64_t kIntervalNs = 20 * kNsPerMs;
    pacer_.setPace(1, kPace);
    const int64_t beganNs = monotonicNowNs();
    pacer_.add(1, 5, 0);
    const std::vector<Sent> sent = waitFor(5);
    ASSERT_EQ(sent.size(), 5u);
    for (uint32_t i = 0; i < 5; ++i) {
        EXPECT_EQ(sent[i].finished, i + 1);
        // A preemption may delay a call, which shortens the time to the next one. No call is early.
        EXPECT_GE(sent[i].atNs - beganNs, i * kIntervalNs);
    }
}

TEST_F(CreditPacerTest, passesOtherProgramsAndShownFramesThrough) {
    pacer_.setPace(1, 1);
    pacer_.add(1, 3, 0);
    pacer_.add(2, 8, 4);
    pacer_.add(1, 3, 1);
    const std::vector<Sent> sent = waitFor(3);
    EXPECT_EQ(sent[0].finished, 1u);
    EXPECT_EQ(sent[1].client, 2u);
    EXPECT_EQ(sent[1].finished, 8u);
    EXPECT_EQ(sent[1].shown, 4u);
    EXPECT_EQ(sent[2].client, 1u);
    EXPECT_EQ(sent[2].finished, 1u);
    EXPECT_EQ(sent[2].shown, 1u);
}

TEST_F(CreditPacerTest, endsWhileFramesWait) {
    pacer_.setPace(1, 0.5);
    pacer_.add(1, 100, 0);
    waitFor(1); // the destructor must not wait for the other frames
}

} // namespace
} // namespace mural
