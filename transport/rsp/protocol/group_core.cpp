#include "transport/rsp/protocol/group_core.hpp"

#include <algorithm>
#include <utility>

#include "common/base/copy_bytes.hpp"
#include "common/base/little_endian.hpp"

namespace mural::rsp {

// Sends the group's datagrams once by multicast and once into each tunnel. Datagrams of a tunnelled member all go
// through the host.
class GroupCore::Datagrams : public DatagramSink {
public:
    explicit Datagrams(GroupCore& core) : core_(core) {}

    std::span<std::byte> datagram(MemberId to, size_t bytes) override {
        finish();
        to_ = to;
        const auto tunnelledPeer = [&](MemberId id) {
            const auto found = core_.members_.find(id);
            return found != core_.members_.end() && !found->second.multicast;
        };
        copied_ = core_.tunnelled_ || (core_.anyTunnel_ && (to == kEverybody || tunnelledPeer(to)));
        if (!copied_) return core_.out_.datagram(to, bytes);
        copy_.assign(bytes, std::byte{0});
        return copy_;
    }
    // Completes the last datagram.
    void finish() {
        if (!copied_) return;
        copied_ = false;
        if (core_.tunnelled_) return core_.tunnel(to_, copy_);
        bool anyDirect = false;
        for (const auto& [id, m] : core_.members_) {
            if (to_ != kEverybody && to_ != id) continue;
            if (m.multicast)
                anyDirect = true;
            else
                core_.tunnel(id, copy_);
        }
        if (anyDirect) copyBytes(copy_, core_.out_.datagram(to_, copy_.size()));
    }

private:
    GroupCore& core_;
    MemberId to_ = 0;
    bool copied_ = false;
    std::vector<std::byte> copy_;
};

GroupCore::GroupCore(const GroupSettings& settings, GroupOutput& out)
    : settings_(settings), out_(out), datagrams_(std::make_unique<Datagrams>(*this)), probeNonce_(settings.probeSeed) {
    if (!settings_.host) return;
    shape_ = {settings_.datagramBytes - kStreamHeaderBytes - kLengthBytes - tagBytes(settings_.keys.seal),
              settings_.windowDatagrams};
    makeSender();
    live_ = true;
}

GroupCore::~GroupCore() = default;

void GroupCore::makeSender() {
    SenderSettings s;
    s.shape = shape_;
    s.self = self_;
    s.rate = settings_.rate;
    s.parity = settings_.parity;
    s.tagBytes = tagBytes(settings_.keys.seal);
    s.heartbeatNs = heartbeatNs(self_);
    sender_ = std::make_unique<Sender>(s, Sequence(settings_.firstSequence));
}

Receiver* GroupCore::receiver(MemberId from) {
    const auto found = receivers_.find(from);
    if (found == receivers_.end()) return nullptr;
    touch(from);
    return found->second.get();
}

void GroupCore::touch(MemberId from) {
    if (!touched_.empty() && touched_.back() == from) return; // the common case
    if (std::ranges::find(touched_, from) == touched_.end()) touched_.push_back(from);
}

Receiver* GroupCore::ofMember(MemberId from) {
    if (active_.receiver && active_.from == from) {
        touch(from);
        return active_.receiver;
    }
    Receiver* const r = members_.contains(from) ? receiver(from) : nullptr;
    active_ = {from, r};
    return r;
}

void GroupCore::socketDropped(uint32_t count) {
    if (count == dropped_) return;
    dropped_ = count;
    for (auto& [id, r] : receivers_) r->socketDropped(count);
}

void GroupCore::begin() {
    Join join;
    join.uuid = settings_.uuid;
    join.udpPort = settings_.udpPort;
    join.socketDatagrams = settings_.socketDatagrams;
    join.maxDatagramBytes = settings_.maxDatagramBytes;
    join.seals = settings_.seals;
    join.multicast = settings_.multicast;
    out_.control(kHost, join);
}

std::optional<MemberId> GroupCore::connected(const std::string& address, const std::string& name, int64_t nowNs) {
    if (nextId_ >= kEverybody) return {};
    const auto id = static_cast<MemberId>(nextId_++);
    candidates_[id] = {address, name, {}, false, 0, nowNs};
    return id;
}

void GroupCore::disconnected(MemberId id, int64_t nowNs) {
    takeLate(nowNs);
    if (!settings_.host) {
        over_ = true;
        return;
    }
    candidates_.erase(id);
    remove(id, GoneReason::Cut);
}

void GroupCore::inputControl(MemberId from, const ControlMessage& message, int64_t nowNs) {
    const auto* gone = std::get_if<MemberGone>(&message);
    // processed immediately: it is the reason for the end of the connection
    const bool removesUs = gone && !settings_.host && gone->id == self_;
    if (!removesUs && (!late_.empty() || (std::holds_alternative<Tunnel>(message) && out_.behind()))) {
        if (late_.empty()) lateSinceNs_ = nowNs;
        late_.emplace_back(from, message);
        return;
    }
    std::visit([&](const auto& m) { take(from, m, nowNs); }, message);
    datagrams_->finish();
}

void GroupCore::takeLate(int64_t nowNs) {
    for (const auto& [from, message] : std::exchange(late_, {}))
        std::visit([&, id = from](const auto& m) { take(id, m, nowNs); }, message);
}

ReceiveBuffers GroupCore::landing() { return active_.receiver ? active_.receiver->landing() : ReceiveBuffers{}; }

// Returns true for a probe of full size. Members that lost multicast are tested by probes only, at growing intervals.
bool GroupCore::showsMulticast(std::span<const std::byte> datagram) const {
    if (datagram.size() != kStreamHeaderBytes + shape_.payloadBytes) return false;
    const auto header = readHeader(datagram);
    return header && header->from == kHost && header->type == Type::Data;
}

void GroupCore::inputDatagram(std::span<const std::byte> datagram, int64_t nowNs) {
    if (unshown_ && showsMulticast(datagram)) {
        unshown_ = false;
        out_.control(kHost, Probed{probeNonce_});
    }
    deliver(datagram, nowNs);
}

void GroupCore::deliver(std::span<const std::byte> datagram, int64_t nowNs) {
    const auto header = readHeader(datagram);
    if (!header) return;
    if (header->type == Type::Probe) {
        if (!settings_.host && (!live_ || tunnelled_) && datagram.size() >= kProbeHeaderBytes) {
            const auto nonce = loadLittle<uint32_t>(datagram.data() + kHeaderBytes);
            if (nonce == probeNonce_) out_.control(kHost, Probed{nonce});
        }
    } else if (header->type == Type::Feedback) {
        if (!sender_) return;
        if (const auto f = readFeedback(datagram)) sender_->input(*f, nowNs);
    } else if (Receiver* r = ofMember(header->from)) {
        if (const auto d = readStream(*header, datagram)) r->input(*d, nowNs);
    }
}

int64_t GroupCore::tick(int64_t nowNs) {
    int64_t next = nowNs + settings_.heartbeatNs;
    if (!late_.empty()) {
        if (nowNs - lateSinceNs_ > kMaxLateNs || !out_.behind())
            takeLate(nowNs);
        else
            next = std::min(next, lateSinceNs_ + kMaxLateNs + 1);
    }
    if (settings_.host) {
        probe(nowNs);
        probeUnreached(nowNs);
        if (!candidates_.empty()) next = std::min(next, nowNs + kBetweenProbesNs);
    }
    if (sender_ && live_) next = std::min(next, sender_->tick(nowNs, *datagrams_));
    // After the tick, which compensates clock jumps.
    if (settings_.host && (watchedNs_ == INT64_MIN || nowNs - watchedNs_ >= kBetweenWatchesNs)) {
        watchMembers(nowNs);
        watchedNs_ = nowNs;
    }
    next = std::min(next, tickReceivers(nowNs));
    datagrams_->finish();
    return next;
}

// Ticks only receivers with work: of many members most are idle, and visiting each costs more than the active one.
int64_t GroupCore::tickReceivers(int64_t nowNs) {
    const auto tickReceiver = [&](MemberId id, Receiver& r) {
        if (members_.contains(id)) receiversDueNs_ = std::min(receiversDueNs_, r.tick(nowNs, *datagrams_));
    };
    if (nowNs >= receiversDueNs_) {
        receiversDueNs_ = INT64_MAX;
        for (auto& [id, r] : receivers_) tickReceiver(id, *r);
    } else {
        for (const MemberId id : touched_) {
            if (const auto found = receivers_.find(id); found != receivers_.end()) tickReceiver(id, *found->second);
        }
    }
    touched_.clear();
    return receiversDueNs_;
}

void GroupCore::membersChanged() {
    active_ = {};
    anyTunnel_ = std::ranges::any_of(members_, [](const auto& m) { return !m.second.multicast; });
}

void GroupCore::tunnel(MemberId to, std::span<const std::byte> datagram) {
    Tunnel t{to, {datagram.begin(), datagram.end()}};
    out_.control(settings_.host ? to : kHost, t);
}

void GroupCore::part(MemberId id, GoneReason reason) {
    if (members_.erase(id) == 0) return;
    membersChanged();
    if (sender_) sender_->removeMember(id);
    out_.memberGone(id, reason);
}

void GroupCore::addPeer(MemberId id, MemberInfo info, int64_t nowNs) {
    info.fromByte = sender_->writtenBytes();
    members_[id] = info;
    membersChanged();
    out_.memberCame(id, info);
    const Sequence first = sender_->addMember(id, nowNs);
    const StreamStart start{self_, id, first};
    out_.control(settings_.host ? id : kHost, start);
}

} // namespace mural::rsp
