// When a reader looks at its sockets: how much is gathered, and that it delays nothing for long.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "transport/rsp/receive_moderation.hpp"

namespace mural::rsp {
namespace {

constexpr int64_t kBeginNs = 1'000'000'000'000;
constexpr int64_t kUs = 1000;
constexpr uint32_t kSocketDatagrams = 4096;
constexpr uint32_t kMember = 1;

// Datagrams come every so often; who waits looks, and rests as it is told. Returns the looks.
int looksAtAFlow(ReceiveModeration& m, int64_t everyNs, int64_t lastingNs, int64_t& longestNs) {
    int looks = 0;
    int64_t seenNs = kBeginNs;
    for (int64_t nowNs = kBeginNs + everyNs; nowNs < kBeginNs + lastingNs;) {
        m.looked({.datagrams = static_cast<size_t>((nowNs - seenNs) / everyNs)}, nowNs);
        seenNs = nowNs;
        ++looks;
        const int64_t restNs = m.restNs(nowNs, kMember);
        EXPECT_LE(restNs, (nowNs - kBeginNs) / ReceiveModeration::kShareOfFlow);
        longestNs = std::max(longestNs, restNs);
        nowNs += std::max(restNs, everyNs);
    }
    return looks;
}

TEST(ReceiveModeration, GathersWhatFlows) {
    ReceiveModeration m(kSocketDatagrams);
    int64_t longestNs = 0;
    EXPECT_LT(looksAtAFlow(m, 12 * kUs, 100'000 * kUs, longestNs), 8333 / 20);
    EXPECT_GE(longestNs, ReceiveModeration::kBetweenTurnsNs);
    EXPECT_LE(longestNs, ReceiveModeration::kMostRestNs);
}

// A socket of few datagrams is not left until it may be full, and the same flow into a large one is left for longest.
TEST(ReceiveModeration, ASmallSocketIsLookedAtBeforeItIsFull) {
    constexpr uint32_t kFew = 100;
    ReceiveModeration m(kFew);
    int64_t longestNs = 0;
    (void)looksAtAFlow(m, 12 * kUs, 100'000 * kUs, longestNs);
    EXPECT_LE(longestNs, 12 * kUs * kFew / 3);
    EXPECT_GE(longestNs, 12 * kUs * kFew / 5);
    // What is left behind by one look counts with what the next one finds.
    const int64_t endNs = kBeginNs + 100'000 * kUs;
    m.looked({.datagrams = 1}, endNs);
    m.looked({.datagrams = 32, .mayBeMore = true}, endNs);
    m.looked({.datagrams = 32, .mayBeMore = true}, endNs);
    m.looked({.datagrams = 16}, endNs + 160 * kUs); // 2 us between two
    EXPECT_EQ(m.restNs(endNs + 160 * kUs, kMember), 0) << "50 us: a timer is later than that";
}

TEST(ReceiveModeration, LooksAtOnceForTheFirstDatagramsAndAfterAnUrgentOne) {
    ReceiveModeration m(kSocketDatagrams);
    EXPECT_EQ(m.restNs(kBeginNs, kMember), 0);
    int64_t longestNs = 0;
    (void)looksAtAFlow(m, 12 * kUs, 50'000 * kUs, longestNs);
    const int64_t endNs = kBeginNs + 50'000 * kUs;
    m.looked({.datagrams = 1}, endNs);
    EXPECT_GT(m.restNs(endNs, kMember), 0);
    m.looked({.datagrams = 1, .urgent = true}, endNs);
    EXPECT_EQ(m.restNs(endNs, kMember), 0);
    m.looked({.datagrams = 1}, endNs + 100 * kUs);
    EXPECT_EQ(m.restNs(endNs + 100 * kUs, kMember), 0);
}

// More comes than a look takes: who rested after each would fall behind for good.
TEST(ReceiveModeration, LooksAgainAtOnceWhereSomethingWasLeft) {
    ReceiveModeration m(kSocketDatagrams);
    int64_t longestNs = 0;
    (void)looksAtAFlow(m, 12 * kUs, 50'000 * kUs, longestNs);
    const int64_t endNs = kBeginNs + 50'000 * kUs;
    m.looked({.datagrams = 64, .mayBeMore = true}, endNs);
    EXPECT_EQ(m.restNs(endNs, kMember), 0);
    m.looked({.datagrams = 3}, endNs + 50 * kUs);
    EXPECT_GT(m.restNs(endNs + 50 * kUs, kMember), 0);
}

// Who reads for 300 us, or is late by that, looks at its next turn again; and no two of eight members look within a quarter of a millisecond.
TEST(ReceiveModeration, EachMemberOfAMachineHasTurnsOfItsOwn) {
    std::vector<int64_t> turnsNs;
    for (const uint32_t member : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
        ReceiveModeration m(kSocketDatagrams);
        int64_t nowNs = kBeginNs;
        int64_t sinceNs = 0;
        for (int look = 0; look < 200; ++look) {
            m.looked({.datagrams = 30}, nowNs + 300 * kUs);
            const int64_t restNs = std::max(m.restNs(nowNs + 300 * kUs, member), 100 * kUs);
            sinceNs = std::exchange(nowNs, nowNs + 300 * kUs + restNs);
        }
        EXPECT_EQ(nowNs - sinceNs, ReceiveModeration::kBetweenTurnsNs) << "member " << member;
        turnsNs.push_back(nowNs % ReceiveModeration::kBetweenTurnsNs);
    }
    std::ranges::sort(turnsNs);
    turnsNs.push_back(turnsNs.front() + ReceiveModeration::kBetweenTurnsNs);
    for (size_t i = 1; i < turnsNs.size(); ++i) EXPECT_GE(turnsNs[i] - turnsNs[i - 1], 250 * kUs);
}

// On a busy machine writer and reader are late by milliseconds: short rests anew behind each of them cost more than all the rest.
TEST(ReceiveModeration, AFlowThatIsLateGoesOn) {
    ReceiveModeration m(kSocketDatagrams);
    int64_t longestNs = 0;
    (void)looksAtAFlow(m, 12 * kUs, 100'000 * kUs, longestNs);
    const int64_t lateNs = kBeginNs + 106'000 * kUs;
    m.looked({}, lateNs - 3'000 * kUs); // nothing was there
    EXPECT_GE(m.restNs(lateNs - 3'000 * kUs, kMember), ReceiveModeration::kLeastToTurnNs);
    m.looked({.datagrams = 500}, lateNs);
    EXPECT_GE(m.restNs(lateNs, kMember), ReceiveModeration::kLeastToTurnNs);
}

TEST(ReceiveModeration, AFlowThatHasStoppedIsOver) {
    ReceiveModeration m(kSocketDatagrams);
    int64_t longestNs = 0;
    (void)looksAtAFlow(m, 12 * kUs, 50'000 * kUs, longestNs);
    const int64_t laterNs = kBeginNs + 50'000 * kUs + ReceiveModeration::kMostSilenceNs;
    EXPECT_EQ(m.restNs(laterNs, kMember), 0);
    m.looked({.datagrams = 1}, laterNs);
    EXPECT_EQ(m.restNs(laterNs, kMember), 0);
}

} // namespace
} // namespace mural::rsp
