// What a group waits for: sockets, a time that another thread sets, and a timeout; each wakes, and none for longer than once.
#include <gtest/gtest.h>

#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "common/quick_clock.hpp"
#include "transport/rsp/arrivals.hpp"

namespace mural::rsp {
namespace {

constexpr int64_t kLongNs = 20 * kNsPerS; // no test takes that long but by a fault

struct SocketPair {
    std::array<int, 2> ends{-1, -1};
    SocketPair() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends.data()), 0); }
    ~SocketPair() {
        close(ends[0]);
        close(ends[1]);
    }
};

int64_t waitedNs(Arrivals& arrivals, int64_t timeoutNs, size_t sockets) {
    const int64_t beganNs = quickNowNs();
    EXPECT_EQ(arrivals.wait(timeoutNs).size(), sockets);
    return quickNowNs() - beganNs;
}

TEST(Arrivals, ATimeoutIsOfNanoseconds) {
    auto arrivals = Arrivals::open();
    ASSERT_TRUE(arrivals) << arrivals.error().message;
    int64_t shortestNs = kLongNs;
    for (int i = 0; i < 50; ++i) {
        const int64_t tookNs = waitedNs(*arrivals, 200'000, 0);
        EXPECT_GE(tookNs, 200'000);
        shortestNs = std::min(shortestNs, tookNs);
    }
    EXPECT_LT(shortestNs, kNsPerMs); // at least once, on a busy machine, too
    EXPECT_LT(waitedNs(*arrivals, 0, 0), kLongNs);
    EXPECT_LT(waitedNs(*arrivals, -kNsPerS, 0), kLongNs);
}

TEST(Arrivals, WhatIsAtASocketStaysUntilItIsFetched) {
    SocketPair pair;
    auto arrivals = Arrivals::open();
    ASSERT_TRUE(arrivals && arrivals->add(pair.ends[0]));
    ASSERT_EQ(send(pair.ends[1], "a", 1, 0), 1);
    for (int i = 0; i < 3; ++i) {
        const auto ready = arrivals->wait(kLongNs);
        ASSERT_EQ(ready.size(), 1u);
        EXPECT_EQ(ready[0], pair.ends[0]);
    }
    char byte = 0;
    ASSERT_EQ(recv(pair.ends[0], &byte, 1, 0), 1);
    EXPECT_TRUE(arrivals->wait(0).empty());
}

TEST(Arrivals, ATimeWakesWhoSleepsOnce) {
    auto arrivals = Arrivals::open();
    ASSERT_TRUE(arrivals);
    std::thread other([&] { arrivals->wakeAt(quickNowNs() + 20 * kNsPerMs); });
    EXPECT_LT(waitedNs(*arrivals, kLongNs, 0), kLongNs / 2);
    other.join();
    EXPECT_GE(waitedNs(*arrivals, 30 * kNsPerMs, 0), 30 * kNsPerMs) << "it was told twice that it is time";
    arrivals->wakeAt(0); // long past
    EXPECT_LT(waitedNs(*arrivals, kLongNs, 0), kLongNs / 2);
}

TEST(QuickClock, IsTheSameClock) {
    for (int i = 0; i < 1000; ++i) {
        const int64_t before = monotonicNowNs();
        const int64_t quick = quickNowNs();
        EXPECT_LE(before, quick);
        EXPECT_LE(quick, monotonicNowNs());
    }
}

} // namespace
} // namespace mural::rsp
