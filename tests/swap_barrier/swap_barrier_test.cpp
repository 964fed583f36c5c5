// Leader and followers with real connections: they show frames together, and a dead member delays the others only
// briefly.
#include <algorithm>
#include <atomic>
#include <gtest/gtest.h>
#include <latch>
#include <thread>

#include "nodes/swap_barrier/barrier_follower.hpp"
#include "nodes/swap_barrier/barrier_leader.hpp"
#include "tests/recorded_log.hpp"

namespace mural {
namespace {

ChannelSecret secretOf(int number) {
    ChannelSecret secret{};
    secret[0] = static_cast<std::byte>(number);
    return secret;
}

std::unique_ptr<SwapBarrier> followerOf(const BarrierLeader& leader, int rank) {
    auto follower = BarrierFollower::connect(rank, secretOf(1), "127.0.0.1", leader.port(), Deadline::inMs(5000));
    EXPECT_TRUE(follower.ok()) << (follower ? "" : follower.error().message);
    return follower ? std::move(*follower) : nullptr;
}

TEST(SwapBarrier, showsAFrameOnAllMembersTogether) {
    constexpr int kMembers = 4;
    constexpr uint32_t kFrames = 50;
    const RecordedLog lines;
    BarrierLeader leader(kMembers, secretOf(1));
    ASSERT_TRUE(leader.listen(true).ok());
    std::vector<std::unique_ptr<SwapBarrier>> followers;
    for (int rank = 1; rank < kMembers; ++rank) followers.push_back(followerOf(leader, rank));
    std::vector<std::atomic<int>> drawn(kFrames + 1);
    std::atomic<int> early{0};
    const auto run = [&](SwapBarrier& barrier, int rank) {
        for (uint32_t f = 1; f <= kFrames; ++f) {
            // one member draws longer
            if ((f + static_cast<uint32_t>(rank)) % 9 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(3));
            ++drawn[f];
            const int64_t showNs = barrier.await({1, 1, f});
            early += drawn[f] != kMembers ? 1 : 0;
            EXPECT_LT(showNs - monotonicNowNs(), 5 * kNsPerMs);
            sleepUntilNs(showNs);
            barrier.shown({1, 1, f}, monotonicNowNs());
        }
    };
    std::vector<std::thread> threads;
    for (int rank = 1; rank < kMembers; ++rank)
        threads.emplace_back([&, rank] { run(*followers[static_cast<size_t>(rank) - 1], rank); });
    run(leader, 0);
    for (auto& thread : threads) thread.join();
    EXPECT_EQ(early, 0);
    EXPECT_TRUE(lines.texts().empty());
    const SwapBarrierNumbers n = *leader.numbers();
    EXPECT_EQ(n.skew.swaps, kFrames - 1); // the last swap would be reported with the next one
    EXPECT_GT(n.clockErrorNs, 0);
    EXPECT_LE(n.skew.medianNs, n.skew.p99Ns);
    EXPECT_LE(n.skew.p99Ns, n.skew.maxNs);
}

// At the end of a run members leave one by one, and the leader's numbers are read when it ends itself.
TEST(SwapBarrier, keepsClocksOfMembersThatLeft) {
    const RecordedLog lines;
    BarrierLeader leader(2, secretOf(1));
    ASSERT_TRUE(leader.listen(true).ok());
    auto follower = followerOf(leader, 1);
    std::thread other([&] {
        for (uint32_t f = 1; f <= 3; ++f) (void)follower->await({1, 1, f});
        follower.reset();
    });
    // the fourth is released when the other member's end is known
    for (uint32_t f = 1; f <= 4; ++f) leader.await({1, 1, f});
    other.join();
    EXPECT_GT(leader.numbers()->clockErrorNs, 0);
}

TEST(SwapBarrier, reportsALostMemberAndContinues) {
    const RecordedLog lines;
    BarrierLeader leader(3, secretOf(1));
    ASSERT_TRUE(leader.listen(true).ok());
    auto one = followerOf(leader, 1);
    auto two = followerOf(leader, 2);
    std::thread other([&] { (void)one->await({1, 1, 1}); });
    std::thread dies([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        two.reset();
    });
    const int64_t beganNs = monotonicNowNs();
    (void)leader.await({1, 1, 1});
    EXPECT_LT(monotonicNowNs() - beganNs, 2 * kNsPerS); // far below the timeout
    other.join(), dies.join();
    ASSERT_EQ(lines.texts().size(), 1U);
    EXPECT_NE(lines.texts()[0].find("member 3"), std::string::npos) << lines.texts()[0];
}

TEST(SwapBarrier, waitsOnceForAMemberThatNeverArrives) {
    const RecordedLog lines;
    BarrierLeader leader(2, secretOf(1), 300);
    ASSERT_TRUE(leader.listen(true).ok());
    (void)leader.await({1, 1, 1});
    const int64_t beganNs = monotonicNowNs();
    for (uint32_t f = 2; f < 100; ++f) (void)leader.await({1, 1, f});
    EXPECT_LT(monotonicNowNs() - beganNs, kNsPerS);
    ASSERT_EQ(lines.texts().size(), 1U);
    EXPECT_NE(lines.texts()[0].find("300 ms"), std::string::npos) << lines.texts()[0];
}

TEST(SwapBarrier, letsAFollowerShowFramesWithoutItsLeader) {
    const RecordedLog lines;
    auto leader = std::make_unique<BarrierLeader>(2, secretOf(1));
    ASSERT_TRUE(leader->listen(true).ok());
    auto follower = followerOf(*leader, 1);
    std::thread ends([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        leader.reset();
    });
    EXPECT_EQ(follower->await({1, 1, 1}), 0);
    ends.join();
    for (uint32_t f = 2; f < 1000; ++f) EXPECT_EQ(follower->await({1, 1, f}), 0);
    ASSERT_EQ(lines.texts().size(), 1U);
    EXPECT_NE(lines.texts()[0].find("leader is lost"), std::string::npos) << lines.texts()[0];
}

TEST(SwapBarrier, rejectsForeignConnections) {
    const RecordedLog lines;
    BarrierLeader leader(2, secretOf(1));
    ASSERT_TRUE(leader.listen(true).ok());
    EXPECT_FALSE(BarrierFollower::connect(1, secretOf(2), "127.0.0.1", leader.port(), Deadline::inMs(3000)).ok());
    // an invalid rank
    EXPECT_FALSE(BarrierFollower::connect(2, secretOf(1), "127.0.0.1", leader.port(), Deadline::inMs(3000)).ok());
}

} // namespace
} // namespace mural
