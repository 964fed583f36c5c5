// The times at which a reader polls its sockets: the amount that accumulates, and the limit of the delay.
#include <gtest/gtest.h>

#include "transport/rsp/protocol/receive_moderation.hpp"

namespace mural::rsp {
namespace {

constexpr int64_t kBeginNs = 1'000'000'000'000;
constexpr int64_t kUs = 1000;
constexpr uint32_t kSocketDatagrams = 4096;

// Simulates a flow and a reader that polls and rests as advised. Returns the number of polls.
int pollsOfFlow(ReceiveModeration& m, int64_t everyNs, int64_t lastingNs, int64_t& longestNs) {
    int polls = 0;
    int64_t seenNs = kBeginNs;
    for (int64_t nowNs = kBeginNs + everyNs; nowNs < kBeginNs + lastingNs;) {
        m.onPolled({.datagrams = static_cast<size_t>((nowNs - seenNs) / everyNs)}, nowNs);
        seenNs = nowNs;
        ++polls;
        const int64_t restNs = m.restNs(nowNs);
        EXPECT_LE(restNs, (nowNs - kBeginNs) / ReceiveModeration::kShareOfFlow);
        longestNs = std::max(longestNs, restNs);
        nowNs += std::max(restNs, everyNs);
    }
    return polls;
}

TEST(ReceiveModeration, accumulatesDatagramsOfAFlow) {
    ReceiveModeration m(kSocketDatagrams);
    int64_t longestNs = 0;
    EXPECT_LT(pollsOfFlow(m, 12 * kUs, 100'000 * kUs, longestNs), 8333 / 20);
    EXPECT_EQ(longestNs, ReceiveModeration::kMaxRestNs);
}

// A small socket is polled before it can be full; the same flow into a large one rests for the maximum.
TEST(ReceiveModeration, pollsASmallSocketBeforeItIsFull) {
    constexpr uint32_t kFew = 100;
    ReceiveModeration m(kFew);
    int64_t longestNs = 0;
    (void)pollsOfFlow(m, 12 * kUs, 100'000 * kUs, longestNs);
    EXPECT_LE(longestNs, 12 * kUs * kFew / 3);
    EXPECT_GE(longestNs, 12 * kUs * kFew / 5);
    // Datagrams left by one poll count together with the next poll's.
    const int64_t endNs = kBeginNs + 100'000 * kUs;
    m.onPolled({.datagrams = 1}, endNs);
    m.onPolled({.datagrams = 32, .mayBeMore = true}, endNs);
    m.onPolled({.datagrams = 32, .mayBeMore = true}, endNs);
    m.onPolled({.datagrams = 16}, endNs + 160 * kUs); // 2 us apart
    EXPECT_EQ(m.restNs(endNs + 160 * kUs), 0) << "50 us: a timer is later than that";
}

TEST(ReceiveModeration, pollsAtOnceForFirstAndUrgentDatagrams) {
    ReceiveModeration m(kSocketDatagrams);
    EXPECT_EQ(m.restNs(kBeginNs), 0);
    int64_t longestNs = 0;
    (void)pollsOfFlow(m, 12 * kUs, 50'000 * kUs, longestNs);
    const int64_t endNs = kBeginNs + 50'000 * kUs;
    m.onPolled({.datagrams = 1}, endNs);
    EXPECT_GT(m.restNs(endNs), 0);
    m.onPolled({.datagrams = 1, .urgent = true}, endNs);
    EXPECT_EQ(m.restNs(endNs), 0);
    m.onPolled({.datagrams = 1}, endNs + 100 * kUs);
    EXPECT_EQ(m.restNs(endNs + 100 * kUs), 0);
}

// More arrives than one poll reads: a reader that rested after each would never catch up.
TEST(ReceiveModeration, pollsAgainAtOnceWhenDatagramsAreLeft) {
    ReceiveModeration m(kSocketDatagrams);
    int64_t longestNs = 0;
    (void)pollsOfFlow(m, 12 * kUs, 50'000 * kUs, longestNs);
    const int64_t endNs = kBeginNs + 50'000 * kUs;
    m.onPolled({.datagrams = 64, .mayBeMore = true}, endNs);
    EXPECT_EQ(m.restNs(endNs), 0);
    m.onPolled({.datagrams = 3}, endNs + 50 * kUs);
    EXPECT_GT(m.restNs(endNs + 50 * kUs), 0);
}

// On a busy machine writer and reader are late by milliseconds. Restarting with short rests after each delay would be
// expensive.
TEST(ReceiveModeration, continuesALateFlow) {
    ReceiveModeration m(kSocketDatagrams);
    int64_t longestNs = 0;
    (void)pollsOfFlow(m, 12 * kUs, 100'000 * kUs, longestNs);
    const int64_t lateNs = kBeginNs + 106'000 * kUs;
    m.onPolled({}, lateNs - 3'000 * kUs); // no datagram arrived
    EXPECT_EQ(m.restNs(lateNs - 3'000 * kUs), ReceiveModeration::kMaxRestNs);
    m.onPolled({.datagrams = 500}, lateNs);
    EXPECT_EQ(m.restNs(lateNs), ReceiveModeration::kMaxRestNs);
}

TEST(ReceiveModeration, endsAStoppedFlow) {
    ReceiveModeration m(kSocketDatagrams);
    int64_t longestNs = 0;
    (void)pollsOfFlow(m, 12 * kUs, 50'000 * kUs, longestNs);
    const int64_t laterNs = kBeginNs + 50'000 * kUs + ReceiveModeration::kMaxSilenceNs;
    EXPECT_EQ(m.restNs(laterNs), 0);
    m.onPolled({.datagrams = 1}, laterNs);
    EXPECT_EQ(m.restNs(laterNs), 0);
}

} // namespace
} // namespace mural::rsp
