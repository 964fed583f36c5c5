// Membership of GroupCore: its control messages.
#include <algorithm>

#include "common/base/little_endian.hpp"
#include "transport/rsp/protocol/group_core.hpp"

namespace mural::rsp {

namespace {
constexpr int64_t kJoinNs = 10'000'000'000;    // timeout of the first message on a connection
constexpr int64_t kTryAgainNs = 3'000'000'000; // interval of probes for multicast
constexpr int64_t kMaxTryAgainNs = 60'000'000'000;
constexpr int64_t kTrySoonNs = 20'000'000; // the same after silence: the member may only have been stopped
constexpr int64_t kSoonGrows = 4;
constexpr int64_t kSilentBeats = 4; // missed heartbeats that count as silence
constexpr size_t kMaxMembers = 1000;
constexpr size_t kMinDatagramBytes = 512;
constexpr uint32_t kMaxWindow = 1u << 16;
} // namespace

// Runs at the host.
void GroupCore::take(MemberId from, const Join& m, int64_t nowNs) {
    const auto found = candidates_.find(from);
    if (!settings_.host || found == candidates_.end() || found->second.joined) return;
    std::string why;
    if (members_.size() >= kMaxMembers) why = "the group is full: " + std::to_string(kMaxMembers) + " members";
    if ((m.seals >> static_cast<int>(settings_.keys.seal) & 1) == 0)
        why = std::string("this member does not support the session's encryption, ") + nameOf(settings_.keys.seal) +
              "; choose another --seal for the session";
    if (!why.empty()) {
        out_.control(from, Refused{why});
        candidates_.erase(found);
        return out_.hangUp(from, why);
    }
    Candidate& c = found->second;
    c.join = m;
    c.joined = true;
    c.nonce = ++probeNonce_;
    c.untilNs = nowNs + settings_.probeNs;
    probedNs_ = INT64_MIN; // probe immediately
    Welcome w;
    w.self = from;
    w.keys = settings_.keys;
    w.group = settings_.group;
    w.datagramBytes = settings_.datagramBytes;
    w.windowDatagrams = settings_.windowDatagrams;
    w.probeNonce = c.nonce;
    out_.control(from, w);
}

// Runs at members.
void GroupCore::take(MemberId, const Welcome& m, int64_t) {
    if (settings_.host || sender_) return;
    const size_t overhead = kStreamHeaderBytes + kLengthBytes + tagBytes(m.keys.seal);
    if (m.datagramBytes < kMinDatagramBytes || m.windowDatagrams < 64 || m.windowDatagrams > kMaxWindow ||
        (m.windowDatagrams & (m.windowDatagrams - 1)) != 0) {
        over_ = true;
        return out_.hangUp(kHost, "the host sent invalid settings; check that both run the same version");
    }
    self_ = m.self;
    settings_.keys = m.keys;
    probeNonce_ = m.probeNonce;
    shape_ = {m.datagramBytes - overhead, m.windowDatagrams};
    makeSender();
    out_.welcomed(m);
}

void GroupCore::probe(int64_t nowNs) {
    const bool send = nowNs - kBetweenProbesNs >= probedNs_;
    std::vector<MemberId> late;
    for (auto& [id, c] : candidates_) {
        if (!c.joined) {
            if (nowNs - c.untilNs > kJoinNs) out_.hangUp(id, "it connected but sent no join request");
            continue;
        }
        if (!c.join.multicast || nowNs >= c.untilNs) {
            late.push_back(id);
            continue;
        }
        if (!send) continue;
        probedNs_ = nowNs;
        sendProbe(c.nonce);
    }
    for (const MemberId id : late) {
        const Candidate c = candidates_.at(id);
        candidates_.erase(id);
        if (c.join.multicast) unreached_[id] = {c.nonce, nowNs + kTryAgainNs, kTryAgainNs, kTryAgainNs, {}};
        admit(id, {c.join.uuid, c.name, c.address, c.join.udpPort, false}, nowNs);
    }
}

void GroupCore::sendProbe(uint32_t nonce) {
    const auto d = out_.datagram(kEverybody, settings_.datagramBytes - tagBytes(settings_.keys.seal));
    std::ranges::fill(d, std::byte{0});
    StreamDatagram header;
    header.type = Type::Probe;
    header.from = self_;
    writeStreamHeader(header, d);
    storeLittle(d.data() + kHeaderBytes, nonce);
}

void GroupCore::probeUnreached(int64_t nowNs) {
    for (auto& [id, u] : unreached_) {
        if (members_.at(id).multicast) continue;
        if (u.silentSinceNs && sender_->members().at(id).receivedNs > *u.silentSinceNs) {
            u.silentSinceNs.reset();
            u.soonNs = kTrySoonNs;
            u.againNs = nowNs;
        }
        if (nowNs < u.againNs) continue;
        u.againNs = nowNs + std::min(u.soonNs, u.waitNs);
        u.soonNs = std::min(kSoonGrows * u.soonNs, kMaxTryAgainNs);
        sendProbe(u.nonce);
    }
}

// Runs at the host.
void GroupCore::take(MemberId from, const Probed& m, int64_t nowNs) {
    if (!settings_.host) return;
    if (const auto u = unreached_.find(from);
        u != unreached_.end() && u->second.nonce == m.nonce && !members_.at(from).multicast)
        return reroute(from, true, m.nonce);
    const auto found = candidates_.find(from);
    if (found == candidates_.end() || !found->second.joined || found->second.nonce != m.nonce) return;
    const Candidate c = found->second;
    candidates_.erase(found);
    admit(from, {c.join.uuid, c.name, c.address, c.join.udpPort, true}, nowNs);
}

// Announces the new member to all, and all members to the new one, itself first.
void GroupCore::admit(MemberId id, const MemberInfo& info, int64_t nowNs) {
    const MemberCame came{id, info.uuid, info.address, info.udpPort, info.multicast};
    out_.control(id, came);
    out_.control(id, MemberCame{kHost, settings_.uuid, "", settings_.udpPort, info.multicast});
    for (const auto& [other, m] : members_) {
        // A tunnelled member receives everything through the host.
        out_.control(id, MemberCame{other, m.uuid, m.address, m.udpPort, m.multicast});
        out_.control(other, came);
    }
    addPeer(id, info, nowNs);
}

// Runs at members.
void GroupCore::take(MemberId, const MemberCame& m, int64_t nowNs) {
    if (settings_.host || !sender_) return;
    if (m.id == self_) {
        live_ = true;
        tunnelled_ = unshown_ = !m.multicast;
        return;
    }
    if (live_) addPeer(m.id, {m.uuid, "", m.address, m.udpPort, m.multicast}, nowNs);
}

void GroupCore::take(MemberId from, const StreamStart& m, int64_t) {
    if (settings_.host && m.writer != from) return; // forged sender
    if (settings_.host && m.reader != self_) {
        if (members_.contains(m.reader)) out_.control(m.reader, m);
        return;
    }
    if (m.reader != self_ || !members_.contains(m.writer) || receivers_.contains(m.writer)) return;
    ReceiverSettings s;
    s.shape = shape_;
    s.self = self_;
    s.writer = m.writer;
    s.socketDatagrams = settings_.socketDatagrams;
    s.heartbeatNs = heartbeatNs(m.writer);
    receivers_[m.writer] = std::make_unique<Receiver>(s, m.first);
    touch(m.writer);
}

// Runs at members.
void GroupCore::take(MemberId, const MemberGone& m, int64_t) {
    if (settings_.host) return;
    if (m.id == self_) over_ = true;
    part(m.id, m.reason);
}

void GroupCore::take(MemberId from, const Tunnel& m, int64_t nowNs) {
    const auto header = readHeader(m.datagram);
    if (!header) return;
    if (!settings_.host) return deliver(m.datagram, nowNs);
    if (header->from != from || !members_.contains(from)) return; // forged sender
    for (const auto& [id, other] : members_) {
        if (id != from && (m.to == id || m.to == kEverybody)) out_.control(id, Tunnel{id, m.datagram});
    }
    if (m.to == self_ || m.to == kEverybody) deliver(m.datagram, nowNs);
}

void GroupCore::take(MemberId, const Refused& m, int64_t) {
    if (settings_.host) return;
    over_ = true;
    out_.hangUp(kHost, m.why);
}

// Runs at the host.
void GroupCore::take(MemberId from, const Leave&, int64_t) {
    if (!settings_.host) return;
    candidates_.erase(from);
    remove(from, GoneReason::Left);
    out_.hangUp(from, "it left");
}

void GroupCore::take(MemberId from, const Ping& m, int64_t) {
    if (!m.answer) out_.control(settings_.host ? from : kHost, Ping{m.number, true});
}

// Runs at members.
void GroupCore::take(MemberId, const Rerouted& m, int64_t) {
    if (settings_.host) return;
    if (m.id == self_) {
        tunnelled_ = !m.multicast;
        unshown_ = false;
        probeNonce_ = m.probeNonce;
    }
    const auto found = members_.find(m.id);
    if (found == members_.end()) return;
    found->second.multicast = m.multicast;
    membersChanged();
    out_.memberRerouted(m.id, m.multicast);
}

// Host: sends each datagram over the member's connection as well; repairs continue. `silent`: the member may only have
// been stopped, and is probed again as soon as it sends.
void GroupCore::toConnection(MemberId id, bool silent, int64_t nowNs) {
    Unreached& u = unreached_[id];
    u.waitNs = u.waitNs == 0 ? kTryAgainNs : std::min(2 * u.waitNs, kMaxTryAgainNs);
    u.againNs = nowNs + u.waitNs;
    u.soonNs = u.waitNs;
    if (silent)
        u.silentSinceNs = nowNs;
    else
        u.silentSinceNs.reset();
    u.nonce = ++probeNonce_;
    reroute(id, false, u.nonce);
}

// Informs all members.
void GroupCore::reroute(MemberId id, bool multicast, uint32_t probeNonce) {
    members_.at(id).multicast = multicast;
    membersChanged();
    out_.control(id, Rerouted{id, multicast, probeNonce});
    for (const auto& [other, m] : members_)
        if (other != id) out_.control(other, Rerouted{id, multicast, 0});
    sender_->requestFeedback();
    out_.memberRerouted(id, multicast);
}

void GroupCore::evict(MemberId id, GoneReason reason, const std::string& why) {
    if (!settings_.host || !members_.contains(id)) return;
    out_.control(id, MemberGone{id, reason});
    out_.hangUp(id, why);
    remove(id, reason);
}

// Host: evicts a member and informs all.
void GroupCore::remove(MemberId id, GoneReason reason) {
    if (!members_.contains(id)) return;
    unreached_.erase(id);
    part(id, reason);
    for (const auto& [other, m] : members_) out_.control(other, MemberGone{id, reason});
}

// Host: evicts members that are silent or stall the stream. A member that may have lost multicast is served over its
// connection for half of that time first.
void GroupCore::watchMembers(int64_t nowNs) {
    std::vector<std::pair<MemberId, GoneReason>> hopeless;
    std::vector<std::pair<MemberId, bool>> unreached; // second: silent
    for (const auto& [id, m] : sender_->members()) {
        const int64_t quietNs = nowNs - m.receivedNs;
        const int64_t stillNs = sender_->waitsFor(m) ? nowNs - m.movedNs : 0;
        const bool lacks = sender_->lacks(m);
        if (quietNs > settings_.silentNs)
            hopeless.emplace_back(id, GoneReason::Silent);
        else if (settings_.stalled == StallPolicy::Eject && stillNs > settings_.stalledNs)
            hopeless.emplace_back(id, GoneReason::Stalled);
        else if (members_.at(id).multicast &&
                 (quietNs > settings_.silentNs / 2 || (lacks && stillNs > settings_.stalledNs / 2)))
            unreached.emplace_back(id, quietNs > kSilentBeats * settings_.heartbeatNs);
    }
    for (const auto& [id, reason] : hopeless)
        evict(id, reason,
              reason == GoneReason::Silent ? "it sent nothing for too long" : "it stalled the group for too long");
    for (const auto& [id, silent] : unreached) toConnection(id, silent, nowNs);
}

} // namespace mural::rsp
