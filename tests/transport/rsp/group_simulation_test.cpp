// Groups on a simulated network: members join, leave, die, freeze and become unreachable while each may write to all.
#include <gtest/gtest.h>

#include "tests/transport/rsp/simulated_group.hpp"

namespace mural::rsp::test {
namespace {

TEST(GroupSimulation, deliversWritesOfAllToAll) {
    SimulatedGroup group(1);
    for (int i = 0; i < 5; ++i) group.join();
    ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.allLive(); }));
    for (auto& p : group.processes) p.write(200'000 + p.core.self() * 1000u);
    ASSERT_TRUE(group.run(20 * kNsPerS, [&] { return group.processes[5].written > 0 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
}

// Every member reads every stream, so idle traffic grows with the square of the number of members.
TEST(GroupSimulation, limitsIdleTraffic) {
    SimulatedGroup group(12);
    constexpr uint64_t kOthers = 8;
    for (uint64_t i = 0; i < kOthers; ++i) group.join();
    ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.allLive(); }));
    std::vector<SenderCounters> before;
    for (auto& p : group.processes) before.push_back(p.core.sender()->counters());
    constexpr uint64_t kSeconds = 10;
    group.run(kSeconds * kNsPerS, [] { return false; });
    for (size_t place = 0; place < group.processes.size(); ++place) {
        const SenderCounters& after = group.processes[place].core.sender()->counters();
        const uint64_t words = (after.feedback - before[place].feedback) / kOthers;
        const uint64_t beats = after.polls - before[place].polls;
        const uint64_t perSecond = place == 0 ? 10 : 1; // the host's stream monitors all members
        EXPECT_LE(words, kSeconds * perSecond + 1) << place;
        EXPECT_GE(words, kSeconds * perSecond * 8 / 10) << place;
        EXPECT_LE(beats, kSeconds * perSecond + 1) << place;
        EXPECT_GE(beats, kSeconds * perSecond * 8 / 10) << place;
        EXPECT_TRUE(group.processes[place].gone.empty());
    }
}

TEST(GroupSimulation, admitsSixteenSimultaneousJoinsAtFivePercentLoss) {
    for (uint64_t seed = 1; seed <= 100; ++seed) {
        SimulatedGroup group(seed);
        for (int i = 0; i < 16; ++i) group.network.faults(group.join()).loss = 0.05;
        group.network.faults(0).loss = 0.05;
        ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.allLive(); })) << "seed " << seed;
    }
}

TEST(GroupSimulation, tunnelsToAMemberWithoutMulticast) {
    SimulatedGroup group(3);
    for (int i = 0; i < 4; ++i) group.join();
    group.deaf = {2, 3};
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    EXPECT_FALSE(group.processes[0].core.members().at(*group.idOf(2)).multicast);
    EXPECT_TRUE(group.processes[0].core.members().at(*group.idOf(1)).multicast);
    for (auto& p : group.processes) p.write(300'000);
    ASSERT_TRUE(group.run(20 * kNsPerS, [&] { return group.processes[4].written > 0 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
}

TEST(GroupSimulation, continuesSoonAfterAMemberIsKilled) {
    SimulatedGroup group(4, [](GroupSettings& s) { s.rate.maxBytesPerS = 20e6; });
    for (int i = 0; i < 4; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    group.processes[0].write(20 << 20);
    group.run(200 * kNsPerMs, [] { return false; });
    group.kill(2);
    group.run(20 * kNsPerMs, [] { return false; });
    const uint64_t before = group.processes[1].readBytes[kHost];
    group.run(50 * kNsPerMs, [] { return false; });
    EXPECT_GT(group.processes[1].readBytes[kHost], before + 500'000);
    ASSERT_TRUE(group.run(20 * kNsPerS, [&] { return group.processes[0].written == 20 << 20 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
    EXPECT_EQ(group.processes[1].gone.at(*group.idOf(2)), GoneReason::Cut);
}

TEST(GroupSimulation, evictsASilentMemberInTime) {
    SimulatedGroup group(5, [](GroupSettings& s) { s.rate.maxBytesPerS = 20e6; });
    for (int i = 0; i < 3; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    group.processes[0].write(60 << 20);
    group.run(200 * kNsPerMs, [] { return false; });
    group.network.faults(2).cut = true; // an unplugged cable: no connection reset
    const int64_t cutNs = group.network.nowNs();
    ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.processes[1].gone.contains(*group.idOf(2)); }));
    EXPECT_LE(group.network.nowNs() - cutNs, 1200 * kNsPerMs);
    group.processes[2].dead = true;
    ASSERT_TRUE(group.run(20 * kNsPerS, [&] { return group.processes[0].written == 60 << 20 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
}

TEST(GroupSimulation, tunnelsToAMemberThatLosesMulticast) {
    SimulatedGroup group(11, [](GroupSettings& s) { s.rate.maxBytesPerS = 20e6; });
    for (int i = 0; i < 3; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    for (auto& p : group.processes) p.write(20 << 20);
    group.run(200 * kNsPerMs, [] { return false; });
    group.deaf = {2}; // like a switch that forgets a subscription
    const MemberId deaf = *group.idOf(2);
    ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.processes[1].rerouted.contains(deaf); }));
    EXPECT_TRUE(group.processes[0].rerouted.contains(deaf));
    ASSERT_TRUE(group.run(60 * kNsPerS, [&] { return group.processes[3].written == 20 << 20 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
    for (const auto& p : group.processes) EXPECT_TRUE(p.gone.empty());
    EXPECT_TRUE(group.processes[0].core.members().at(*group.idOf(1)).multicast);
}

// A member that was stopped long enough for a tunnel may read its connection first. Its socket still holds the rest.
TEST(GroupSimulation, losesNothingWhenTheTunnelIsReadBeforeTheSocket) {
    SimulatedGroup group(12, [](GroupSettings& s) { s.rate.maxBytesPerS = 20e6; });
    for (int i = 0; i < 3; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    group.processes[0].write(20 << 20);
    group.run(200 * kNsPerMs, [] { return false; });
    const MemberId stopped = *group.idOf(2);
    group.network.freeze(2);
    ASSERT_TRUE(group.run(900 * kNsPerMs, [&] { return group.processes[1].rerouted.contains(stopped); }));
    group.run(100 * kNsPerMs, [] { return false; }); // polls enter its tunnel
    group.network.thaw(2);
    ASSERT_TRUE(group.run(60 * kNsPerS, [&] { return group.processes[0].wroteAll() && group.allRead(); }));
    EXPECT_GT(group.tunnelledBytes[2], 0u);
    EXPECT_EQ(group.wrongBytes(), 0u);
    for (const auto& [id, m] : group.processes[0].core.sender()->members()) EXPECT_EQ(m.lost, 0u) << id;
    EXPECT_EQ(group.processes[0].core.sender()->counters().resent, 0u);
}

TEST(GroupSimulation, returnsToMulticastAtOnceAfterAStop) {
    SimulatedGroup group(16, [](GroupSettings& s) {
        s.rate.maxBytesPerS = 20e6;
        s.silentNs = 4 * kNsPerS;
        s.stalled = StallPolicy::Wait;
    });
    for (int i = 0; i < 3; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    group.processes[0].write(40 << 20);
    const MemberId stopped = *group.idOf(2);
    for (int time = 0; time < 3; ++time) {
        group.run(200 * kNsPerMs, [] { return false; });
        group.network.freeze(2);
        ASSERT_TRUE(group.run(4 * kNsPerS, [&] { return group.processes[1].rerouted.contains(stopped); }));
        group.run(500 * kNsPerMs, [] { return false; });
        group.network.thaw(2);
        ASSERT_TRUE(group.run(100 * kNsPerMs, [&] { return !group.processes[1].rerouted.contains(stopped); })) << time;
    }
    ASSERT_TRUE(group.run(60 * kNsPerS, [&] { return group.processes[0].wroteAll() && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
    EXPECT_LT(group.tunnelledBytes[2], 2u << 20);
    for (const auto& p : group.processes) EXPECT_TRUE(p.gone.empty());
}

TEST(GroupSimulation, returnsToMulticastWhenItReachesTheMemberAgain) {
    SimulatedGroup group(13, [](GroupSettings& s) { s.rate.maxBytesPerS = 5e6; });
    for (int i = 0; i < 3; ++i) group.join();
    group.deaf = {2}; // from the start
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    const MemberId deaf = *group.idOf(2);
    for (auto& p : group.processes) p.write(40 << 20);
    EXPECT_FALSE(group.run(5 * kNsPerS, [&] { return group.processes[0].core.members().at(deaf).multicast; }));
    group.deaf = {};
    ASSERT_TRUE(group.run(5 * kNsPerS, [&] { return group.processes[3].core.members().at(deaf).multicast; }));
    EXPECT_TRUE(group.processes[0].core.members().at(deaf).multicast);
    group.deaf = {2}; // lost a second time
    ASSERT_TRUE(group.run(3 * kNsPerS, [&] { return group.processes[3].rerouted.contains(deaf); }));
    ASSERT_TRUE(group.run(90 * kNsPerS, [&] { return group.processes[2].written == 40 << 20 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
    for (const auto& p : group.processes) EXPECT_TRUE(p.gone.empty());
}

// A lost segment of the control connection arrives 200 ms late, so the member cannot see a probe in time. The multicast
// stream reaches it anyway, and must not fill its tunnel for seconds.
TEST(GroupSimulation, usesMulticastForAMemberWithALateWelcome) {
    SimulatedGroup group(15, [](GroupSettings& s) { s.rate.maxBytesPerS = 5e6; });
    group.join();
    group.lateControlNs[2] = GroupSettings{}.probeNs + 50 * kNsPerMs;
    group.join();
    ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.allLive(); }));
    const MemberId late = *group.idOf(2);
    ASSERT_FALSE(group.processes[0].core.members().at(late).multicast);
    group.processes[0].write(10 << 20);
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.processes[0].core.members().at(late).multicast; }));
    ASSERT_TRUE(group.run(30 * kNsPerS, [&] { return group.processes[0].written == 10 << 20 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
    EXPECT_TRUE(group.processes[0].core.members().at(late).multicast);
    EXPECT_LT(group.tunnelledBytes[2], 2u << 20);
    for (const auto& p : group.processes) EXPECT_TRUE(p.gone.empty());
}

// The host numbers its probes from probeSeed. The join's probes were sent before multicast failed.
TEST(GroupSimulation, ignoresRepliesToEarlierProbes) {
    SimulatedGroup group(14, [](GroupSettings& s) { s.rate.maxBytesPerS = 5e6; });
    for (int i = 0; i < 3; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    const MemberId deaf = *group.idOf(2);
    group.processes[0].write(20 << 20);
    group.deaf = {2};
    ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.processes[0].rerouted.contains(deaf); }));
    GroupCore& host = group.processes[0].core;
    for (uint32_t nonce = 0; nonce <= GroupSettings{}.probeSeed + 3; ++nonce)
        host.inputControl(deaf, Probed{nonce}, group.network.nowNs());
    EXPECT_FALSE(host.members().at(deaf).multicast);
}

TEST(GroupSimulation, doesNotTunnelToASlowReader) {
    SimulatedGroup group(12, [](GroupSettings& s) { s.stalled = StallPolicy::Wait; });
    for (int i = 0; i < 2; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    group.processes[2].reads = false;
    group.processes[0].write(8 << 20);
    const auto allDone = [&] { return group.processes[0].written == 8 << 20 && group.allRead(); };
    EXPECT_FALSE(group.run(10 * kNsPerS, allDone));
    EXPECT_TRUE(group.processes[0].rerouted.empty());
    group.processes[2].reads = true;
    EXPECT_TRUE(group.run(10 * kNsPerS, allDone));
}

TEST(GroupSimulation, waitsForOrEjectsAMemberThatDoesNotReadAsConfigured) {
    for (const StallPolicy policy : {StallPolicy::Wait, StallPolicy::Eject}) {
        SimulatedGroup group(6, [&](GroupSettings& s) { s.stalled = policy; });
        for (int i = 0; i < 2; ++i) group.join();
        ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
        group.processes[2].reads = false;
        group.processes[0].write(8 << 20);
        const bool done = group.run(5 * kNsPerS, [&] { return group.processes[1].readBytes[kHost] == 8 << 20; });
        EXPECT_EQ(done, policy == StallPolicy::Eject);
        EXPECT_EQ(group.processes[2].core.over(), policy == StallPolicy::Eject);
        const auto gone = group.processes[1].gone.find(*group.idOf(2));
        EXPECT_EQ(gone != group.processes[1].gone.end() && gone->second == GoneReason::Stalled,
                  policy == StallPolicy::Eject);
    }
}

TEST(GroupSimulation, endsWithItsHost) {
    SimulatedGroup group(7);
    for (int i = 0; i < 2; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    group.processes[0].dead = true;
    for (size_t i = 1; i <= 2; ++i) group.processes[i].core.disconnected(kHost, group.network.nowNs());
    EXPECT_TRUE(group.processes[1].core.over());
}

TEST(GroupSimulation, refusesAMemberWithoutEncryption) {
    SimulatedGroup group(8);
    const size_t place = group.join([](GroupSettings& s) { s.seals = 1; });
    group.run(kNsPerS, [] { return false; });
    EXPECT_NE(group.processes[place].hungUp.find("siphash"), std::string::npos) << group.processes[place].hungUp;
    EXPECT_TRUE(group.processes[place].core.over());
    EXPECT_TRUE(group.processes[0].core.members().empty());
}

TEST(ControlMessage, survivesArbitraryBytes) {
    std::mt19937 random(9);
    const std::vector<ControlMessage> messages{
        Join{},        Welcome{}, Probed{}, MemberCame{}, StreamStart{}, MemberGone{}, Tunnel{1, {std::byte{1}}},
        Refused{"no"}, Leave{},   Ping{}};
    size_t accepted = 0;
    for (int i = 0; i < 100'000; ++i) {
        auto bytes = encode(messages[random() % messages.size()]);
        ASSERT_TRUE(decode(bytes));
        if (random() % 3 == 0) bytes.resize(random() % (bytes.size() + 8));
        for (uint32_t flips = random() % 4; flips > 0 && !bytes.empty(); --flips)
            bytes[random() % bytes.size()] = static_cast<std::byte>(random());
        accepted += decode(bytes).has_value();
    }
    EXPECT_GT(accepted, 1000u);
}

} // namespace
} // namespace mural::rsp::test
