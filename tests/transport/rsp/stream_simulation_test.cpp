// The protocol with every fault of the simulated network. Each test prints the seed of a failure.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "common/base/clock.hpp"
#include "tests/sanitized.hpp"
#include "tests/transport/rsp/simulated_stream.hpp"

namespace mural::rsp::test {
namespace {

constexpr double kMbit = 1e6 / 8;

// Expects all bytes at all members, in order, once. Returns the simulated seconds.
double expectAllArrives(const StreamPlan& plan, int64_t forS = 120) {
    SCOPED_TRACE("seed " + std::to_string(plan.seed));
    SimulatedStream stream(plan);
    const int64_t began = stream.network().nowNs();
    EXPECT_TRUE(stream.run(forS * kNsPerS));
    EXPECT_EQ(stream.wrongBytes(), 0u);
    for (size_t i = 0; i < stream.memberCount(); ++i)
        EXPECT_EQ(stream.member(i).readBytes, plan.bytes) << "member " << i;
    EXPECT_EQ(stream.sender().counters().refused, 0u);
    return static_cast<double>(stream.network().nowNs() - began) * 1e-9;
}

TEST(StreamSimulation, deliversWithoutFaults) {
    for (const size_t members : {1, 2, 8, 100}) expectAllArrives({.members = members, .bytes = 1 << 20});
}

TEST(StreamSimulation, deliversEmptyAndSmallStreams) {
    for (const uint64_t bytes : {1, 2, 1429, 1430, 1431, 32 * 1430, 32 * 1430 + 1})
        expectAllArrives({.members = 3, .bytes = bytes});
}

TEST(StreamSimulation, deliversWithAnyLossRate) {
    for (const double loss : {0.001, 0.01, 0.05, 0.2, 0.5}) {
        for (uint64_t seed = 1; seed <= 5; ++seed) {
            StreamPlan plan{.seed = seed, .members = 4, .bytes = 1 << 20, .flushEveryBytes = 20'000};
            plan.toMembers.loss = plan.toWriter.loss = loss;
            expectAllArrives(plan);
        }
    }
}

TEST(StreamSimulation, deliversWithBurstLosses) {
    for (const double length : {10.0, 100.0, 1000.0}) {
        StreamPlan plan{.seed = 11, .members = 4, .bytes = 4 << 20};
        plan.toMembers.burstEnds = 1 / length;
        plan.toMembers.burstBegins = 0.02 / length;
        expectAllArrives(plan);
    }
}

TEST(StreamSimulation, deliversWithDelaysDuplicatesAndReordering) {
    StreamPlan plan{.seed = 21, .members = 4, .bytes = 8 << 20, .rate = {150 * kMbit}};
    plan.toMembers.late = 0.05;
    plan.toMembers.lateNs = 3 * kNsPerMs;
    plan.toMembers.twice = 0.02;
    plan.toMembers.delayNs = plan.toMembers.jitterNs = 100'000;
    SimulatedStream stream(plan);
    ASSERT_TRUE(stream.run(60 * kNsPerS));
    EXPECT_EQ(stream.wrongBytes(), 0u);
    // The receiver learns the delay, so late datagrams cause few repairs.
    const auto& c = stream.sender().counters();
    EXPECT_LT(c.rows, c.datagrams / 20) << "of " << c.datagrams;
}

TEST(StreamSimulation, deliversWithFlippedBits) {
    for (const Seal seal : {Seal::Tag, bestEncryption()}) {
        StreamPlan plan{.seed = 25, .members = 3, .bytes = 2 << 20, .flushEveryBytes = 20'000, .seal = seal};
        plan.toMembers.flipped = plan.toWriter.flipped = 0.05;
        SimulatedStream stream(plan);
        ASSERT_TRUE(stream.run(60 * kNsPerS));
        EXPECT_EQ(stream.wrongBytes(), 0u);
        EXPECT_GT(stream.refusedDatagrams(), 100u);
        EXPECT_EQ(stream.sender().counters().refused, 0u);
    }
}

TEST(StreamSimulation, deliversAcrossTheSequenceWrap) {
    for (const uint32_t first : {0xffffff9cu, 0x7fffff9cu, 0xffffffffu}) {
        StreamPlan plan{.seed = 31, .members = 3, .bytes = 4 << 20, .flushEveryBytes = 50'000, .first = first};
        plan.toMembers.loss = 0.02;
        plan.toMembers.late = 0.02;
        plan.toMembers.lateNs = 500'000;
        expectAllArrives(plan);
    }
}

TEST(StreamSimulation, deliversWithLostFeedback) {
    StreamPlan plan{.seed = 41, .members = 4, .bytes = 2 << 20, .flushEveryBytes = 5000};
    plan.toWriter.loss = 0.8;
    expectAllArrives(plan);
}

TEST(StreamSimulation, repairsWithHalfOfThePlainRetransmissions) {
    uint64_t repairs[2] = {};
    for (const bool parity : {false, true}) {
        StreamPlan plan{.seed = 51, .members = 8, .bytes = 16 << 20, .rate = {185 * kMbit}, .parity = parity};
        plan.toMembers.loss = 0.05;
        SimulatedStream stream(plan);
        ASSERT_TRUE(stream.run(60 * kNsPerS));
        EXPECT_EQ(stream.wrongBytes(), 0u);
        repairs[parity] = stream.sender().counters().rows + stream.sender().counters().resent;
    }
    EXPECT_LE(repairs[1], repairs[0] / 2) << "plain: " << repairs[0];
}

// The rate that remains on a lossy link. A larger reduction would mean that chance counts as congestion.
TEST(StreamSimulation, losesLittleMoreRateThanItsRepairs) {
    const auto seconds = [](double loss) {
        StreamPlan plan{.seed = 61, .members = 8, .bytes = 32 << 20, .rate = {185 * kMbit}};
        plan.toMembers.loss = loss;
        plan.toMembers.bytesPerS = 200 * kMbit;
        return expectAllArrives(plan);
    };
    const double without = seconds(0);
    EXPECT_GE(without / seconds(0.001), 0.97);
    EXPECT_GE(without / seconds(0.01), 0.93);
    EXPECT_GE(without / seconds(0.05), 0.80);
}

TEST(StreamSimulation, findsTheRateOfACongestedLink) {
    StreamPlan plan{.seed = 71,
                    .members = 4,
                    .bytes = 64 << 20,
                    .shape = {1430, 4096},
                    .rate = {1000 * kMbit},
                    .socketDatagrams = 4096};
    plan.toMembers.bytesPerS = 200 * kMbit;
    const double seconds = expectAllArrives(plan);
    EXPECT_GE(plan.bytes / seconds, 0.85 * 200 * kMbit * 1430 / (1430 + 100));
}

TEST(StreamSimulation, blocksTheWriterForASlowReader) {
    StreamPlan plan{.seed = 81, .members = 3, .bytes = 8 << 20};
    SimulatedStream stream(plan);
    stream.member(1).readBytesPerS = 4e6;
    const int64_t began = stream.network().nowNs();
    ASSERT_TRUE(stream.run(60 * kNsPerS));
    EXPECT_EQ(stream.wrongBytes(), 0u);
    EXPECT_NEAR(static_cast<double>(stream.network().nowNs() - began) * 1e-9, 8.4e6 / 4e6, 0.3);
}

TEST(StreamSimulation, losesNothingAtAFrozenMemberAndContinuesAtOnce) {
    for (const int64_t frozenMs : {100, 1000, 5000}) {
        StreamPlan plan{.seed = 91, .members = 3, .bytes = 64 << 20, .rate = {185 * kMbit}};
        SimulatedStream stream(plan);
        SimulatedNetwork& network = stream.network();
        stream.run(300 * kNsPerMs, [] { return false; });
        network.freeze(SimulatedStream::host(1));
        stream.run(frozenMs * kNsPerMs, [] { return false; });
        const uint64_t before = stream.member(0).readBytes;
        EXPECT_LT(before, plan.bytes);
        network.thaw(SimulatedStream::host(1));
        stream.run(100 * kNsPerMs, [] { return false; });
        EXPECT_GT(stream.member(0).readBytes, before + static_cast<uint64_t>(0.05 * 185 * kMbit)) << frozenMs << " ms";
        EXPECT_TRUE(stream.run(60 * kNsPerS));
        EXPECT_EQ(stream.wrongBytes(), 0u);
        EXPECT_EQ(network.overflowed(SimulatedStream::host(1)), 0u);
    }
}

TEST(StreamSimulation, blocksAtACutLinkUntilTheMemberIsRemoved) {
    StreamPlan plan{.seed = 101, .members = 3, .bytes = 32 << 20, .rate = {185 * kMbit}};
    SimulatedStream stream(plan);
    stream.run(200 * kNsPerMs, [] { return false; });
    stream.network().faults(SimulatedStream::host(2)).cut = true;
    EXPECT_FALSE(stream.run(3 * kNsPerS));
    const MemberState& silent = stream.sender().members().at(3);
    EXPECT_TRUE(stream.sender().waitsFor(silent));
    EXPECT_GT(stream.network().nowNs() - silent.movedNs, 2 * kNsPerS);
    stream.kill(2);
    stream.remove(2);
    EXPECT_TRUE(stream.run(60 * kNsPerS));
    EXPECT_EQ(stream.wrongBytes(), 0u);
}

TEST(StreamSimulation, losesNothingWhenACutLinkHeals) {
    StreamPlan plan{.seed = 111, .members = 3, .bytes = 16 << 20, .flushEveryBytes = 100'000, .rate = {185 * kMbit}};
    SimulatedStream stream(plan);
    stream.run(100 * kNsPerMs, [] { return false; });
    stream.network().faults(SimulatedStream::host(0)).cut = stream.network().faults(SimulatedStream::host(1)).cut =
        true;
    stream.run(3 * kNsPerS, [] { return false; });
    stream.network().faults(SimulatedStream::host(0)).cut = stream.network().faults(SimulatedStream::host(1)).cut =
        false;
    EXPECT_TRUE(stream.run(60 * kNsPerS));
    EXPECT_EQ(stream.wrongBytes(), 0u);
}

// Nothing arrives for 200 ms at varying members. A member blocked by its losses for 2 s would be evicted, and must stay
// far below that.
TEST(StreamSimulation, repairsBurstsQuickly) {
    StreamPlan plan{.seed = 115,
                    .members = 3,
                    .bytes = 16 << 20,
                    .shape = {1430, 4096},
                    .rate = {80 * kMbit},
                    .socketDatagrams = 4096};
    SimulatedStream stream(plan);
    const auto setCut = [&](size_t member, bool cut) {
        stream.network().faults(SimulatedStream::host(member)).cut = cut;
    };
    stream.run(100 * kNsPerMs, [] { return false; });
    for (int i = 0; i < 8; ++i) {
        setCut(i % 2 * 2, true);
        stream.run(200 * kNsPerMs, [] { return false; });
        setCut(i % 2 * 2, false);
        stream.run(50 * kNsPerMs, [] { return false; });
    }
    EXPECT_TRUE(stream.run(60 * kNsPerS));
    EXPECT_EQ(stream.wrongBytes(), 0u);
    for (const size_t member : {0, 2}) EXPECT_LT(stream.member(member).longestStallNs, kNsPerS) << "member " << member;
}

TEST(StreamSimulation, admitsAndReleasesMembersWhileItFlows) {
    StreamPlan plan{.seed = 121, .members = 2, .bytes = 48 << 20, .flushEveryBytes = 30'000, .rate = {185 * kMbit}};
    plan.toMembers.loss = plan.toWriter.loss = 0.02;
    SimulatedStream stream(plan);
    for (int i = 0; i < 15; ++i) {
        stream.run(100 * kNsPerMs, [] { return false; });
        const size_t joined = stream.join();
        if (i % 2 == 0) continue;
        stream.kill(joined - 1);
        stream.remove(joined - 1);
    }
    EXPECT_TRUE(stream.run(60 * kNsPerS));
    EXPECT_EQ(stream.wrongBytes(), 0u);
}

TEST(StreamSimulation, evictsNoMemberAfterAClockJump) {
    StreamPlan plan{.seed = 131, .members = 2, .bytes = 8 << 20, .rate = {185 * kMbit}};
    SimulatedStream stream(plan);
    stream.run(100 * kNsPerMs, [] { return false; });
    stream.network().jumpClock(30 * kNsPerS);
    stream.run(20 * kNsPerMs, [] { return false; });
    for (const auto& [id, m] : stream.sender().members())
        EXPECT_LT(stream.network().nowNs() - m.receivedNs, kNsPerS) << id;
    EXPECT_TRUE(stream.run(60 * kNsPerS));
    EXPECT_EQ(stream.wrongBytes(), 0u);
}

TEST(StreamSimulation, deliversToAHundredMembersAtOnePercentLoss) {
    StreamPlan plan{.seed = 141, .members = 100, .bytes = 2 << 20, .flushEveryBytes = 100'000};
    plan.toMembers.loss = plan.toWriter.loss = 0.01;
    expectAllArrives(plan);
}

// All faults combined, differently in each round. MURAL_SEEDS=first:count tests more seeds.
TEST(StreamSimulation, survivesRandomSchedules) {
    uint64_t first = 1;
    uint64_t count = mural::testing::rounds(100);
    if (const char* seeds = std::getenv("MURAL_SEEDS")) std::sscanf(seeds, "%lu:%lu", &first, &count);
    for (uint64_t seed = first; seed < first + count; ++seed) {
        std::mt19937_64 random(seed);
        const auto up = [&](double maximum) { return maximum * static_cast<double>(random() % 1000) / 1000; };
        StreamPlan plan{
            .seed = seed,
            .members = 1 + random() % 6,
            .bytes = 1 + random() % 1'000'000,
            .flushEveryBytes = random() % 30'000,
            .first = static_cast<uint32_t>(random() % 3 == 0 ? 0u - random() % 500 : random()),
            .shape = {static_cast<size_t>(random() % 2 ? 1430 : 8 + random() % 200), random() % 2 ? 1024u : 64u},
            .rate = {random() % 2 ? 100 * kMbit : 0},
            .socketDatagrams = static_cast<uint32_t>(32 + random() % 500),
            .parity = random() % 4 != 0};
        for (LinkFaults* f : {&plan.toMembers, &plan.toWriter}) {
            if (random() % 2) f->loss = up(0.3);
            if (random() % 3 == 0) f->burstBegins = up(0.01), f->burstEnds = 0.02 + up(0.3);
            if (random() % 2) f->twice = up(0.2);
            if (random() % 2) f->late = up(0.3), f->lateNs = static_cast<int64_t>(up(5e6));
            f->delayNs = static_cast<int64_t>(up(3e6));
            f->jitterNs = static_cast<int64_t>(up(2e6));
        }
        expectAllArrives(plan, 600);
        if (HasFailure()) return;
    }
}

} // namespace
} // namespace mural::rsp::test
