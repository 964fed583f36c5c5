// Leader and followers with real connections: they show frames together, and a dead member delays the others only
// briefly.
#include <algorithm>
#include <atomic>
#include <gtest/gtest.h>
#include <latch>
#include <mutex>
#include <thread>

#include "nodes/swap_barrier/barrier_follower.hpp"
#include "nodes/swap_barrier/barrier_leader.hpp"

namespace mural {
namespace {

ChannelSecret secretOf(int number) {
    ChannelSecret secret{};
    secret[0] = static_cast<std::byte>(number);
    return secret;
}

class Lines {
public:
    SwapBarrier::Log log() {
        return [this](const std::string& line) {
            const std::lock_guard lock(mutex_);
            lines_.push_back(line);
        };
    }
    [[nodiscard]] std::vector<std::string> all() const {
        const std::lock_guard lock(mutex_);
        return lines_;
    }

private:
    mutable std::mutex mutex_;
    std::vector<std::string> lines_;
};

std::unique_ptr<SwapBarrier> followerOf(const BarrierLeader& leader, int rank, Lines& lines) {
    auto follower =
        BarrierFollower::connect(rank, secretOf(1), "127.0.0.1", leader.port(), Deadline::inMs(5000), lines.log());
    EXPECT_TRUE(follower.ok()) << (follower ? "" : follower.error().message);
    return follower ? std::move(*follower) : nullptr;
}

TEST(SwapBarrier, showsAFrameOnAllMembersTogether) {
    constexpr int kMembers = 4;
    constexpr uint32_t kFrames = 50;
    Lines lines;
    BarrierLeader leader(kMembers, secretOf(1), lines.log());
    ASSERT_TRUE(leader.listen(true).ok());
    std::vector<std::unique_ptr<SwapBarrier>> followers;
    for (int rank = 1; rank < kMembers; ++rank) followers.push_back(followerOf(leader, rank, lines));
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
    EXPECT_TRUE(lines.all().empty());
    const SwapBarrierNumbers n = *leader.numbers();
    EXPECT_EQ(n.skew.swaps, kFrames - 1); // the last swap would be reported with the next one
    EXPECT_GT(n.clockErrorNs, 0);
    EXPECT_LE(n.skew.medianNs, n.skew.p99Ns);
    EXPECT_LE(n.skew.p99Ns, n.skew.maxNs);
}

// At the end of a run members leave one by one, and the leader's numbers are read when it ends itself.
TEST(SwapBarrier, keepsClocksOfMembersThatLeft) {
    Lines lines;
    BarrierLeader leader(2, secretOf(1), lines.log());
    ASSERT_TRUE(leader.listen(true).ok());
    auto follower = followerOf(leader, 1, lines);
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
    Lines lines;
    BarrierLeader leader(3, secretOf(1), lines.log());
    ASSERT_TRUE(leader.listen(true).ok());
    auto one = followerOf(leader, 1, lines);
    auto two = followerOf(leader, 2, lines);
    std::thread other([&] { (void)one->await({1, 1, 1}); });
    std::thread dies([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        two.reset();
    });
    const int64_t beganNs = monotonicNowNs();
    (void)leader.await({1, 1, 1});
    EXPECT_LT(monotonicNowNs() - beganNs, 2 * kNsPerS); // far below the timeout
    other.join(), dies.join();
    ASSERT_EQ(lines.all().size(), 1U);
    EXPECT_NE(lines.all()[0].find("member 3"), std::string::npos) << lines.all()[0];
}

TEST(SwapBarrier, waitsOnceForAMemberThatNeverArrives) {
    Lines lines;
    BarrierLeader leader(2, secretOf(1), lines.log(), 300);
    ASSERT_TRUE(leader.listen(true).ok());
    (void)leader.await({1, 1, 1});
    const int64_t beganNs = monotonicNowNs();
    for (uint32_t f = 2; f < 100; ++f) (void)leader.await({1, 1, f});
    EXPECT_LT(monotonicNowNs() - beganNs, kNsPerS);
    ASSERT_EQ(lines.all().size(), 1U);
    EXPECT_NE(lines.all()[0].find("300 ms"), std::string::npos) << lines.all()[0];
}

TEST(SwapBarrier, letsAFollowerShowFramesWithoutItsLeader) {
    Lines lines;
    auto leader = std::make_unique<BarrierLeader>(2, secretOf(1), lines.log());
    ASSERT_TRUE(leader->listen(true).ok());
    auto follower = followerOf(*leader, 1, lines);
    std::thread ends([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        leader.reset();
    });
    EXPECT_EQ(follower->await({1, 1, 1}), 0);
    ends.join();
    for (uint32_t f = 2; f < 1000; ++f) EXPECT_EQ(follower->await({1, 1, f}), 0);
    ASSERT_EQ(lines.all().size(), 1U);
    EXPECT_NE(lines.all()[0].find("leader is lost"), std::string::npos) << lines.all()[0];
}

TEST(SwapBarrier, rejectsForeignConnections) {
    Lines lines;
    BarrierLeader leader(2, secretOf(1), lines.log());
    ASSERT_TRUE(leader.listen(true).ok());
    EXPECT_FALSE(
        BarrierFollower::connect(1, secretOf(2), "127.0.0.1", leader.port(), Deadline::inMs(3000), lines.log()).ok());
    // an invalid rank
    EXPECT_FALSE(
        BarrierFollower::connect(2, secretOf(1), "127.0.0.1", leader.port(), Deadline::inMs(3000), lines.log()).ok());
}

} // namespace
} // namespace mural
