// Groups on a simulated network: members come, go, die, freeze and are not reached, while each may write to all.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <set>

#include "common/clock.hpp"
#include "tests/transport/rsp/simulated_network.hpp"
#include "transport/rsp/datagram_seal.hpp"
#include "transport/rsp/group_core.hpp"

namespace mural::rsp::test {
namespace {

constexpr int64_t kControlNs = 200'000; // of a message over a control connection
constexpr size_t kMostHosts = 128;

std::byte byteAt(MemberId writer, uint64_t place) {
    return static_cast<std::byte>((place * 0x9e3779b97f4a7c15u + writer * 77u) >> 56);
}

class SimulatedGroup;

// One process: place 0 is the host.
class Process : public GroupOutput {
public:
    Process(SimulatedGroup& group, size_t place, const GroupSettings& settings);

    void control(MemberId to, const ControlMessage& message) override;
    std::span<std::byte> datagram(MemberId to, size_t bytes) override;
    void welcomed(const Welcome& w) override { useKeys(w.keys, w.self); }
    void memberCame(MemberId id, const MemberInfo&) override { opener_->addMember(id); }
    void memberGone(MemberId id, GoneReason reason) override { gone[id] = reason; }
    void memberRerouted(MemberId id, bool multicast) override { multicast ? rerouted.erase(id) : static_cast<size_t>(rerouted.insert(id).second); }
    void hangUp(MemberId id, const std::string& why) override;

    void run();
    void write(uint64_t bytes) { toWrite_ += bytes; }
    // How much of another's stream has been read; where it began is not known to tests of late members.
    std::map<MemberId, uint64_t> readBytes;
    std::map<MemberId, uint64_t> beganAt; // place in the writer's stream
    uint64_t wrongBytes = 0;
    std::map<MemberId, GoneReason> gone;
    std::set<MemberId> rerouted;
    bool dead = false;
    bool reads = true;
    std::string hungUp; // why
    GroupCore core;
    uint64_t written = 0;

private:
    friend class SimulatedGroup;
    void useKeys(const SessionKeys& keys, MemberId self);
    void flushDatagram();
    void readAll();

    SimulatedGroup& group_;
    size_t place_;
    SessionKeys keys_;
    std::unique_ptr<DatagramSealer> sealer_;
    std::unique_ptr<DatagramOpener> opener_;
    uint64_t toWrite_ = 0;
    MemberId to_ = 0;
    std::vector<std::byte> datagram_;
};

class SimulatedGroup {
public:
    explicit SimulatedGroup(uint64_t seed, const std::function<void(GroupSettings&)>& change = {}) : network(seed, kMostHosts) {
        settings_.host = true;
        settings_.keys = makeSessionKeys(Seal::Tag);
        settings_.windowDatagrams = 512;
        settings_.socketDatagrams = 512;
        if (change) change(settings_);
        add(settings_);
    }
    size_t join(const std::function<void(GroupSettings&)>& change = {}) {
        GroupSettings s = settings_;
        s.host = false;
        s.keys = {};
        if (change) change(s);
        const size_t place = add(s);
        network.sendReliably(0, kControlNs, [this, place] {
            const auto id = processes[0].core.connected("simulated", "place" + std::to_string(place), network.nowNs());
            ids_[*id] = place;
            network.sendReliably(place, kControlNs, [this, place] { processes[place].core.begin(); });
        });
        return place;
    }
    // The process ends; its control connection is reset.
    void kill(size_t place) {
        processes[place].dead = true;
        network.sendReliably(0, kControlNs, [this, place] {
            if (const auto id = idOf(place)) processes[0].core.disconnected(*id, network.nowNs());
        });
    }
    [[nodiscard]] std::optional<MemberId> idOf(size_t place) const {
        if (place == 0) return kHost;
        for (const auto& [id, p] : ids_)
            if (p == place) return id;
        return {};
    }
    [[nodiscard]] std::optional<size_t> placeOf(MemberId id) const {
        if (id == kHost) return 0;
        const auto found = ids_.find(id);
        if (found == ids_.end()) return {};
        return found->second;
    }
    bool run(int64_t forNs, const std::function<bool()>& until) { return network.run(network.nowNs() + forNs, until); }
    [[nodiscard]] bool allLive() const {
        return std::ranges::all_of(processes, [&](const Process& p) {
            return p.dead || (p.core.live() && p.core.members().size() + 1 == alive());
        });
    }
    [[nodiscard]] size_t alive() const {
        return static_cast<size_t>(std::ranges::count_if(processes, [](const Process& p) { return !p.dead; }));
    }
    // Everyone who lives has read all that everyone who lives has written.
    [[nodiscard]] bool allRead() const {
        for (const Process& reader : processes) {
            if (reader.dead) continue;
            for (const Process& writer : processes) {
                if (writer.dead || &writer == &reader || writer.written == 0) continue;
                const auto read = reader.readBytes.find(writer.core.self());
                if (read == reader.readBytes.end() || read->second != writer.written) return false;
            }
        }
        return true;
    }
    [[nodiscard]] uint64_t wrongBytes() const {
        uint64_t count = 0;
        for (const Process& p : processes) count += p.wrongBytes;
        return count;
    }

    SimulatedNetwork network;
    std::deque<Process> processes;
    std::set<size_t> deaf; // places that no multicast reaches

private:
    friend class Process;
    size_t add(const GroupSettings& s) {
        const size_t place = processes.size();
        Process& p = processes.emplace_back(*this, place, s);
        network.onDatagram(place, [&p, this](std::span<std::byte> d) {
            if (p.dead || !p.opener_) return;
            const auto opened = p.opener_->open(d);
            if (!opened.empty()) p.core.inputDatagram(opened, network.nowNs());
        });
        network.onTimer(place, [&p] { p.run(); });
        network.setTimer(place, network.nowNs());
        return place;
    }
    GroupSettings settings_;
    std::map<MemberId, size_t> ids_;
};

Process::Process(SimulatedGroup& group, size_t place, const GroupSettings& settings)
    : core(settings, *this), group_(group), place_(place) {
    if (settings.host) useKeys(settings.keys, kHost);
}

void Process::useKeys(const SessionKeys& keys, MemberId self) {
    keys_ = keys;
    sealer_ = std::make_unique<DatagramSealer>(keys, self);
    opener_ = std::make_unique<DatagramOpener>(keys);
    if (self != kHost) opener_->addMember(kHost);
}

void Process::control(MemberId to, const ControlMessage& message) {
    const auto bytes = encode(message);
    const auto place = place_ == 0 ? group_.placeOf(to) : size_t{0};
    if (!place || dead || group_.network.faults(place_).cut || group_.network.faults(*place).cut) return;
    group_.network.sendReliably(*place, kControlNs, [this, bytes, place] {
        Process& other = group_.processes[*place];
        const auto decoded = decode(bytes);
        ASSERT_TRUE(decoded);
        const auto from = group_.idOf(place_);
        if (!other.dead && from) other.core.inputControl(*from, *decoded, group_.network.nowNs());
    });
}

std::span<std::byte> Process::datagram(MemberId to, size_t bytes) {
    flushDatagram();
    to_ = to;
    datagram_.assign(bytes + tagBytes(keys_.seal), std::byte{0});
    return std::span(datagram_).first(bytes);
}

void Process::flushDatagram() {
    if (datagram_.empty()) return;
    sealer_->seal(datagram_);
    if (to_ == kEverybody) {
        for (size_t i = 0; i < group_.processes.size(); ++i)
            if (i != place_ && !group_.deaf.contains(i) && !group_.deaf.contains(place_)) group_.network.send(i, datagram_);
    } else if (const auto place = group_.placeOf(to_)) {
        group_.network.send(*place, datagram_);
    }
    datagram_.clear();
}

void Process::hangUp(MemberId id, const std::string& why) {
    if (place_ != 0) {
        hungUp = why;
        return;
    }
    const auto place = group_.placeOf(id);
    if (!place) return;
    group_.network.sendReliably(*place, kControlNs, [this, place] {
        if (!group_.processes[*place].dead) group_.processes[*place].core.disconnected(kHost, group_.network.nowNs());
    });
}

void Process::readAll() {
    for (size_t i = 0; i < group_.processes.size() && reads; ++i) {
        const auto id = group_.idOf(i);
        Receiver* r = id && i != place_ ? core.receiver(*id) : nullptr;
        if (!r) continue;
        uint64_t& place = readBytes[*id];
        for (auto bytes = r->readable(); !bytes.empty(); bytes = r->readable()) {
            for (const std::byte b : bytes) wrongBytes += b != byteAt(*id, place++);
            r->consume(bytes.size());
        }
    }
}

void Process::run() {
    if (dead) return;
    readAll();
    if (Sender* s = core.live() ? core.sender() : nullptr) {
        std::array<std::byte, 1000> piece;
        while (written < toWrite_) {
            const size_t want = std::min<uint64_t>(piece.size(), toWrite_ - written);
            for (size_t i = 0; i < want; ++i) piece[i] = byteAt(core.self(), written + i);
            const size_t took = s->write(std::span(piece).first(want));
            written += took;
            if (took < want) break;
            if (written == toWrite_) s->flush();
        }
    }
    const int64_t next = core.tick(group_.network.nowNs());
    flushDatagram();
    group_.network.setTimer(place_, std::max(next, group_.network.nowNs() + 1000));
}

TEST(GroupSimulation, AllWriteToAll) {
    SimulatedGroup group(1);
    for (int i = 0; i < 5; ++i) group.join();
    ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.allLive(); }));
    for (auto& p : group.processes) p.write(200'000 + p.core.self() * 1000u);
    ASSERT_TRUE(group.run(20 * kNsPerS, [&] { return group.processes[5].written > 0 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
}

TEST(GroupSimulation, SixteenJoinAtOnceAtFivePercentLoss) {
    for (uint64_t seed = 1; seed <= 100; ++seed) {
        SimulatedGroup group(seed);
        for (int i = 0; i < 16; ++i) group.network.faults(group.join()).loss = 0.05;
        group.network.faults(0).loss = 0.05;
        ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.allLive(); })) << "seed " << seed;
    }
}

TEST(GroupSimulation, WhomMulticastDoesNotReachIsReachedThroughTheHost) {
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

TEST(GroupSimulation, AKilledMemberHoldsNobodyForLong) {
    SimulatedGroup group(4, [](GroupSettings& s) { s.rate.mostBytesPerS = 20e6; });
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

TEST(GroupSimulation, ASilentMemberIsRemovedWithinItsTime) {
    SimulatedGroup group(5, [](GroupSettings& s) { s.rate.mostBytesPerS = 20e6; });
    for (int i = 0; i < 3; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    group.processes[0].write(60 << 20);
    group.run(200 * kNsPerMs, [] { return false; });
    group.network.faults(2).cut = true; // its cable; nobody tells
    const int64_t cutNs = group.network.nowNs();
    ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.processes[1].gone.contains(*group.idOf(2)); }));
    EXPECT_LE(group.network.nowNs() - cutNs, 1200 * kNsPerMs);
    group.processes[2].dead = true;
    ASSERT_TRUE(group.run(20 * kNsPerS, [&] { return group.processes[0].written == 60 << 20 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
}

TEST(GroupSimulation, WhomMulticastCeasesToReachGoesOnThroughTheHost) {
    SimulatedGroup group(11, [](GroupSettings& s) { s.rate.mostBytesPerS = 20e6; });
    for (int i = 0; i < 3; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    for (auto& p : group.processes) p.write(20 << 20);
    group.run(200 * kNsPerMs, [] { return false; });
    group.deaf = {2}; // as a switch that forgets who listens
    const MemberId deaf = *group.idOf(2);
    ASSERT_TRUE(group.run(2 * kNsPerS, [&] { return group.processes[1].rerouted.contains(deaf); }));
    EXPECT_TRUE(group.processes[0].rerouted.contains(deaf));
    ASSERT_TRUE(group.run(60 * kNsPerS, [&] { return group.processes[3].written == 20 << 20 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
    for (const auto& p : group.processes) EXPECT_TRUE(p.gone.empty());
    EXPECT_TRUE(group.processes[0].core.members().at(*group.idOf(1)).multicast);
}

TEST(GroupSimulation, WhomMulticastReachesAgainIsSentToByItAgain) {
    SimulatedGroup group(13, [](GroupSettings& s) { s.rate.mostBytesPerS = 5e6; });
    for (int i = 0; i < 3; ++i) group.join();
    group.deaf = {2}; // from the beginning
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    const MemberId deaf = *group.idOf(2);
    for (auto& p : group.processes) p.write(40 << 20);
    EXPECT_FALSE(group.run(5 * kNsPerS, [&] { return group.processes[0].core.members().at(deaf).multicast; }));
    group.deaf = {};
    ASSERT_TRUE(group.run(5 * kNsPerS, [&] { return group.processes[3].core.members().at(deaf).multicast; }));
    EXPECT_TRUE(group.processes[0].core.members().at(deaf).multicast);
    group.deaf = {2}; // and it ceases to, once more
    ASSERT_TRUE(group.run(3 * kNsPerS, [&] { return group.processes[3].rerouted.contains(deaf); }));
    ASSERT_TRUE(group.run(90 * kNsPerS, [&] { return group.processes[2].written == 40 << 20 && group.allRead(); }));
    EXPECT_EQ(group.wrongBytes(), 0u);
    for (const auto& p : group.processes) EXPECT_TRUE(p.gone.empty());
}

TEST(GroupSimulation, ASlowReaderIsNotTakenForUnreached) {
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

TEST(GroupSimulation, WhoDoesNotReadIsWaitedForOrEjectedAsIsAsked) {
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
        EXPECT_EQ(gone != group.processes[1].gone.end() && gone->second == GoneReason::Stalled, policy == StallPolicy::Eject);
    }
}

TEST(GroupSimulation, TheHostsEndEndsTheGroup) {
    SimulatedGroup group(7);
    for (int i = 0; i < 2; ++i) group.join();
    ASSERT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    group.processes[0].dead = true;
    for (size_t i = 1; i <= 2; ++i) group.processes[i].core.disconnected(kHost, group.network.nowNs());
    EXPECT_TRUE(group.processes[1].core.over());
}

TEST(GroupSimulation, WhoCannotEncryptIsToldSo) {
    SimulatedGroup group(8);
    const size_t place = group.join([](GroupSettings& s) { s.seals = 1; });
    group.run(kNsPerS, [] { return false; });
    EXPECT_NE(group.processes[place].hungUp.find("siphash"), std::string::npos) << group.processes[place].hungUp;
    EXPECT_TRUE(group.processes[place].core.over());
    EXPECT_TRUE(group.processes[0].core.members().empty());
}

TEST(ControlMessage, NoBytesHurtTheDecoder) {
    std::mt19937 random(9);
    const std::vector<ControlMessage> messages{Join{}, Welcome{}, Probed{}, MemberCame{}, StreamStart{}, MemberGone{}, Tunnel{1, {std::byte{1}}},
        Refused{"no"}, Leave{}, Ping{}};
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
