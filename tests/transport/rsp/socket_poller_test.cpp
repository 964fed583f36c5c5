// A group waits for sockets, a time set by another thread, and a timeout. Each ends one wait.
#include <gtest/gtest.h>

#include <poll.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "common/base/quick_clock.hpp"
#include "transport/rsp/io/socket_poller.hpp"
#include "transport/rsp/io/handover_timer.hpp"

namespace mural::rsp {
namespace {

constexpr int64_t kLongNs = 20 * kNsPerS; // reached only by a faulty wait

struct SocketPair {
    std::array<int, 2> ends{-1, -1};
    SocketPair() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends.data()), 0); }
    ~SocketPair() {
        close(ends[0]);
        close(ends[1]);
    }
};

int64_t waitedNs(SocketPoller& arrivals, int64_t timeoutNs, size_t sockets) {
    const int64_t beganNs = quickNowNs();
    EXPECT_EQ(arrivals.wait(timeoutNs).size(), sockets);
    return quickNowNs() - beganNs;
}

TEST(SocketPoller, waitsWithNanosecondResolution) {
    auto arrivals = SocketPoller::open();
    ASSERT_TRUE(arrivals) << arrivals.error().message;
    int64_t shortestNs = kLongNs;
    for (int i = 0; i < 50; ++i) {
        const int64_t tookNs = waitedNs(*arrivals, 200'000, 0);
        EXPECT_GE(tookNs, 200'000);
        shortestNs = std::min(shortestNs, tookNs);
    }
    EXPECT_LT(shortestNs, kNsPerMs); // holds at least once, even on a busy machine
    EXPECT_LT(waitedNs(*arrivals, 0, 0), kLongNs);
    EXPECT_LT(waitedNs(*arrivals, -kNsPerS, 0), kLongNs);
}

TEST(SocketPoller, keepsASocketReadyUntilItIsRead) {
    SocketPair pair;
    auto arrivals = SocketPoller::open();
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

TEST(SocketPoller, wakesASleeperOnceAtTheSetTime) {
    auto arrivals = SocketPoller::open();
    ASSERT_TRUE(arrivals);
    std::thread other([&] { arrivals->wakeAt(quickNowNs() + 20 * kNsPerMs); });
    EXPECT_LT(waitedNs(*arrivals, kLongNs, 0), kLongNs / 2);
    other.join();
    EXPECT_GE(waitedNs(*arrivals, 30 * kNsPerMs, 0), 30 * kNsPerMs) << "it was told twice that it is time";
    arrivals->wakeAt(0); // long past
    EXPECT_LT(waitedNs(*arrivals, kLongNs, 0), kLongNs / 2);
}

bool readableWithin(int descriptor, int64_t ms) {
    pollfd one{descriptor, POLLIN, 0};
    return poll(&one, 1, static_cast<int>(ms)) == 1;
}

TEST(HandoverTimer, firesOnceWhenNotPostponed) {
    auto timer = HandoverTimer::open();
    ASSERT_TRUE(timer) << timer.error().message;
    EXPECT_FALSE(timer->rang(quickNowNs())) << "nobody has set it";
    const int64_t beganNs = quickNowNs();
    timer->push(beganNs, 20 * kNsPerMs);
    ASSERT_TRUE(readableWithin(timer->descriptor(), 10'000));
    const int64_t endedNs = quickNowNs();
    EXPECT_GE(endedNs - beganNs, 20 * kNsPerMs);
    EXPECT_TRUE(timer->rang(endedNs));
    EXPECT_FALSE(timer->rang(endedNs)) << "twice";
    EXPECT_FALSE(readableWithin(timer->descriptor(), 50));
}

TEST(HandoverTimer, doesNotFireWhilePostponed) {
    auto timer = HandoverTimer::open();
    ASSERT_TRUE(timer);
    constexpr int64_t kAfterNs = 400 * kNsPerMs; // a busy machine may delay this test by part of it
    const int64_t beganNs = quickNowNs();
    int64_t pushedNs = beganNs;
    for (; quickNowNs() - beganNs < 2 * kAfterNs;) {
        pushedNs = quickNowNs();
        timer->push(pushedNs, kAfterNs);
        ASSERT_FALSE(readableWithin(timer->descriptor(), 5));
    }
    EXPECT_TRUE(readableWithin(timer->descriptor(), 10'000));
    EXPECT_GE(quickNowNs() - pushedNs, kAfterNs / 2) << "half of it at least";
    // An earlier time replaces a later one, otherwise a short interval would wait for a longer one.
    const int64_t sooner = quickNowNs();
    timer->push(sooner, 1'000 * kNsPerS);
    timer->push(sooner, kNsPerMs);
    EXPECT_TRUE(readableWithin(timer->descriptor(), 10'000));
}

// The timer fired, but was postponed before its thread got the lock.
TEST(HandoverTimer, reportsAPostponementAfterItFired) {
    auto timer = HandoverTimer::open();
    ASSERT_TRUE(timer);
    timer->push(quickNowNs(), kNsPerMs);
    ASSERT_TRUE(readableWithin(timer->descriptor(), 10'000));
    timer->push(quickNowNs(), 50 * kNsPerMs);
    EXPECT_FALSE(timer->rang(quickNowNs()));
    ASSERT_TRUE(readableWithin(timer->descriptor(), 10'000));
    EXPECT_TRUE(timer->rang(quickNowNs()));
}

// A wake-up would be useless: the leader polls again before it is needed.
TEST(HandoverTimer, isPostponedByALeaderThatSleepsLonger) {
    auto timer = HandoverTimer::open();
    ASSERT_TRUE(timer);
    timer->postpone(quickNowNs(), kNsPerMs);
    EXPECT_FALSE(readableWithin(timer->descriptor(), 20)) << "nobody has set it";
    const int64_t beganNs = quickNowNs();
    timer->push(beganNs, 400 * kNsPerMs);
    timer->postpone(beganNs + 100 * kNsPerMs, kNsPerS); // it is later already
    timer->postpone(beganNs + 500 * kNsPerMs, 300 * kNsPerMs);
    ASSERT_TRUE(readableWithin(timer->descriptor(), 10'000));
    const int64_t tookNs = quickNowNs() - beganNs;
    EXPECT_GE(tookNs, 800 * kNsPerMs);
    EXPECT_TRUE(timer->rang(quickNowNs()));
}

TEST(QuickClock, agreesWithTheSystemClock) {
    for (int i = 0; i < 1000; ++i) {
        const int64_t before = monotonicNowNs();
        const int64_t quick = quickNowNs();
        EXPECT_LE(before, quick);
        EXPECT_LE(quick, monotonicNowNs());
    }
}

} // namespace
} // namespace mural::rsp
