// The processes of a group on a simulated network. Each verifies every byte of every other stream.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "common/base/clock.hpp"
#include "tests/transport/rsp/simulated_network.hpp"
#include "transport/rsp/wire/datagram_cipher.hpp"
#include "transport/rsp/protocol/group_core.hpp"

namespace mural::rsp::test {

constexpr int64_t kControlNs = 200'000; // latency of a control message

class SimulatedGroup;

// One process: index 0 is the host.
class Process : public GroupOutput {
public:
    Process(SimulatedGroup& group, size_t place, const GroupSettings& settings);

    void control(MemberId to, const ControlMessage& message) override;
    std::span<std::byte> datagram(MemberId to, size_t bytes) override;
    bool behind() override;
    void welcomed(const Welcome& w) override { useKeys(w.keys, w.self); }
    void memberCame(MemberId id, const MemberInfo&) override;
    void memberGone(MemberId id, GoneReason reason) override { gone[id] = reason; }
    void memberRerouted(MemberId id, bool multicast) override {
        multicast ? rerouted.erase(id) : static_cast<size_t>(rerouted.insert(id).second);
    }
    void hangUp(MemberId id, const std::string& why) override;

    void run();
    void write(uint64_t bytes) { toWrite_ += bytes; }
    // Read position per stream; a late member starts at the writer's position.
    std::map<MemberId, uint64_t> readBytes;
    uint64_t wrongBytes = 0;
    std::map<MemberId, GoneReason> gone;
    std::set<MemberId> rerouted;
    bool dead = false;
    [[nodiscard]] bool takesPart() const { return !dead && !core.over(); }
    bool reads = true;
    std::string hungUp; // the reason
    [[nodiscard]] bool wroteAll() const { return written == toWrite_; }
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
    static constexpr size_t kMaxHosts = 128;

    explicit SimulatedGroup(uint64_t seed, const std::function<void(GroupSettings&)>& change = {})
        : network(seed, kMaxHosts) {
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
    // All remaining members have read everything that remaining members have written.
    [[nodiscard]] bool allRead() const {
        for (const Process& reader : processes) {
            if (!reader.takesPart()) continue;
            for (const Process& writer : processes) {
                if (!writer.takesPart() || &writer == &reader || writer.written == 0) continue;
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
    std::set<size_t> deaf;                     // processes without multicast
    std::map<size_t, int64_t> lateControlNs;   // additional latency of control messages, by receiver
    std::map<size_t, uint64_t> tunnelledBytes; // by receiver

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

} // namespace mural::rsp::test
