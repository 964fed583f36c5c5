#include "tests/transport/rsp/simulated_group.hpp"

#include <gtest/gtest.h>

#include <array>

namespace mural::rsp::test {

namespace {

std::byte byteAt(MemberId writer, uint64_t place) {
    return static_cast<std::byte>((place * 0x9e3779b97f4a7c15u + writer * 77u) >> 56);
}

} // namespace

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

// Starts this member's stream to the new one.
void Process::memberCame(MemberId id, const MemberInfo&) {
    opener_->addMember(id);
    if (const auto place = group_.placeOf(id)) group_.processes[*place].readBytes.emplace(core.self(), written);
}

void Process::control(MemberId to, const ControlMessage& message) {
    const auto bytes = encode(message);
    const auto place = place_ == 0 ? group_.placeOf(to) : size_t{0};
    if (!place || dead || group_.network.faults(place_).cut || group_.network.faults(*place).cut) return;
    if (std::holds_alternative<Tunnel>(message)) group_.tunnelledBytes[*place] += bytes.size();
    group_.network.sendReliably(*place, kControlNs + group_.lateControlNs[*place], [this, bytes, place] {
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

bool Process::behind() { return group_.network.socketHolds(place_); }

void Process::flushDatagram() {
    if (datagram_.empty()) return;
    sealer_->seal(datagram_);
    if (to_ == kEverybody) {
        for (size_t i = 0; i < group_.processes.size(); ++i)
            if (i != place_ && !group_.deaf.contains(i) && !group_.deaf.contains(place_))
                group_.network.send(i, datagram_);
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

} // namespace mural::rsp::test
