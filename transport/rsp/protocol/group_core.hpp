// State machine of one group member: membership, its own stream to all, and everyone's stream to it. Pure, like Sender
// and Receiver: messages, datagrams and times in; messages, datagrams and events out.
//
// One member is the host. All others have a control connection to it, over which they join, learn of other members, and
// exchange datagrams that UDP does not deliver. A new member is probed by multicast. Without a timely answer its
// datagrams travel through the control connection (a tunnel), with the same sequences and windows and no effect on
// other members. If only the control connection was late, the first full datagram of the stream ends the tunnel.
//
// host:     Join, Welcome, probes ... Probed or timeout, MemberCame to all, and all others to the new member members:
// MemberCame, start of their stream for that member, StreamStart through the host
#pragma once

#include <deque>
#include <memory>

#include "transport/rsp/wire/control_message.hpp"
#include "transport/rsp/protocol/receiver.hpp"
#include "transport/rsp/protocol/sender.hpp"

namespace mural::rsp {

constexpr MemberId kHost = 0;
constexpr int64_t kBetweenProbesNs = 50'000'000;
constexpr int64_t kMaxLateNs = 100'000'000;            // longest time that tunnelled input waits for the sockets
constexpr int64_t kBetweenWatchesNs = 5'000'000;       // interval of checks for silent or stalled members
constexpr size_t kProbeHeaderBytes = kHeaderBytes + 4; // plus the nonce; padding fills the datagram

// Action for a member that stalls the stream.
enum class StallPolicy : uint8_t {
    Wait,  // wait without limit, as in the thesis
    Eject, // evict; the member may join again
};

struct GroupSettings {
    bool host = false;
    Uuid uuid{};
    bool multicast = true; // this member wants multicast
    uint16_t udpPort = 0;  // port of its unicast socket
    uint32_t socketDatagrams = 4096;
    uint16_t maxDatagramBytes = 1472;
    uint8_t seals = 0xff; // supported by this member
    RateSettings rate;
    bool parity = true;
    int64_t heartbeatNs = 100'000'000; // heartbeat of the host's stream and its feedback, which monitor all members
    // heartbeat of other members' streams, whose number of readers grows with the group
    int64_t memberHeartbeatNs = 1'000'000'000;
    // Settings of the host:
    std::string group;
    SessionKeys keys;
    uint16_t datagramBytes = 1472;
    uint32_t windowDatagrams = 4096;
    StallPolicy stalled = StallPolicy::Eject;
    int64_t stalledNs = 2'000'000'000;
    int64_t silentNs = 1'000'000'000;
    int64_t probeNs = 300'000'000; // timeout of the multicast probe
    uint32_t firstSequence = 0;
    uint32_t probeSeed = 1;
};

struct MemberInfo {
    Uuid uuid{};
    std::string name;    // name whose secret it has proven to know; set at the host only
    std::string address; // as seen by the host
    uint16_t udpPort = 0;
    bool multicast = false;
    uint64_t fromByte = 0; // first byte of this process's own stream that the member receives
};

// Actions that the group requests.
class GroupOutput {
public:
    GroupOutput() = default;
    GroupOutput(const GroupOutput&) = delete;
    GroupOutput& operator=(const GroupOutput&) = delete;
    virtual ~GroupOutput() = default;

    // Sends a message over the control connection of a member (host), or to the host (member: kHost).
    virtual void control(MemberId to, const ControlMessage& message) = 0;
    // Returns room for a datagram to the group or one member, as DatagramSink. Fill it before the next call.
    virtual std::span<std::byte> datagram(MemberId to, size_t bytes) = 0;
    // Returns true if sockets hold datagrams that may have been sent before the data of a connection.
    virtual bool behind() = 0;
    // The session is known: sockets and keys can be created.
    virtual void welcomed(const Welcome& w) = 0;
    virtual void memberCame(MemberId id, const MemberInfo& info) = 0;
    virtual void memberGone(MemberId id, GoneReason reason) = 0;
    // Reports whether multicast reaches the member. Otherwise its control connection carries its datagrams.
    virtual void memberRerouted(MemberId id, bool multicast) = 0;
    // Requests the end of the control connection.
    virtual void hangUp(MemberId id, const std::string& why) = 0;
};

class GroupCore {
public:
    GroupCore(const GroupSettings& settings, GroupOutput& out);
    ~GroupCore();

    // Member: the control connection is open.
    void begin();
    // Host: a control connection is open. Returns its id; empty if ids are exhausted.
    std::optional<MemberId> connected(const std::string& address, const std::string& name, int64_t nowNs);
    // Reports the end of the control connection; at the host, of the member's connection.
    void disconnected(MemberId id, int64_t nowNs);
    void inputControl(MemberId from, const ControlMessage& message, int64_t nowNs);
    // Buffers for the next datagrams of the most recent stream.
    ReceiveBuffers landing();
    // Processes an authenticated, decrypted datagram.
    void inputDatagram(std::span<const std::byte> datagram, int64_t nowNs);
    void socketDropped(uint32_t count);
    int64_t tick(int64_t nowNs);
    // Host: evicts the member and informs it.
    void evict(MemberId id, GoneReason reason, const std::string& why);

    // This member's own stream; null before the member is accepted.
    [[nodiscard]] Sender* sender() { return sender_.get(); }
    // Another member's stream; null if there is none (yet). It outlives its member until forgotten, so received data
    // stays readable. Reading may create feedback, which the next tick sends.
    [[nodiscard]] Receiver* receiver(MemberId from);
    void forget(MemberId from) {
        active_ = {};
        receivers_.erase(from);
    }
    [[nodiscard]] const std::map<MemberId, MemberInfo>& members() const { return members_; }
    [[nodiscard]] bool live() const { return live_; }
    [[nodiscard]] bool over() const { return over_; } // the host has left, or has rejected this member
    [[nodiscard]] MemberId self() const { return self_; }

private:
    // Host: a connected process that is not a member yet.
    struct Candidate {
        std::string address;
        std::string name;
        Join join;
        bool joined = false;
        uint32_t nonce = 0;
        int64_t untilNs = 0;
    };
    // Host: a member without multicast, which is probed at intervals.
    struct Unreached {
        uint32_t nonce = 0;
        int64_t againNs = 0;                  // time of the next probe
        int64_t waitNs = 0;                   // interval to the probe after it; grows with each loss of multicast
        int64_t soonNs = 0;                   // shorter interval that applies first
        std::optional<int64_t> silentSinceNs; // start of the silence that caused this state; empty once it sends again
    };
    class Datagrams; // the DatagramSink with tunnels

    void take(MemberId from, const Join& m, int64_t nowNs);
    void take(MemberId from, const Welcome& m, int64_t nowNs);
    void take(MemberId from, const Probed& m, int64_t nowNs);
    void take(MemberId from, const MemberCame& m, int64_t nowNs);
    void take(MemberId from, const StreamStart& m, int64_t nowNs);
    void take(MemberId from, const MemberGone& m, int64_t nowNs);
    void take(MemberId from, const Tunnel& m, int64_t nowNs);
    void take(MemberId from, const Refused& m, int64_t nowNs);
    void take(MemberId from, const Leave& m, int64_t nowNs);
    void take(MemberId from, const Ping& m, int64_t nowNs);
    void take(MemberId from, const Rerouted& m, int64_t nowNs);

    void admit(MemberId id, const MemberInfo& info, int64_t nowNs);
    void addPeer(MemberId id, MemberInfo info, int64_t nowNs);
    void part(MemberId id, GoneReason reason);
    void remove(MemberId id, GoneReason reason);
    void makeSender();
    [[nodiscard]] int64_t heartbeatNs(MemberId writer) const {
        return writer == kHost ? settings_.heartbeatNs : settings_.memberHeartbeatNs;
    }
    void probe(int64_t nowNs);
    void watchMembers(int64_t nowNs);
    void takeLate(int64_t nowNs);
    void toConnection(MemberId id, bool silent, int64_t nowNs);
    void reroute(MemberId id, bool multicast, uint32_t probeNonce);
    void sendProbe(uint32_t nonce);
    void probeUnreached(int64_t nowNs);
    void tunnel(MemberId to, std::span<const std::byte> datagram);
    void touch(MemberId from);
    Receiver* ofMember(MemberId from);
    void deliver(std::span<const std::byte> datagram, int64_t nowNs);
    [[nodiscard]] bool showsMulticast(std::span<const std::byte> datagram) const;
    int64_t tickReceivers(int64_t nowNs);
    void membersChanged();

    GroupSettings settings_;
    GroupOutput& out_;
    std::unique_ptr<Datagrams> datagrams_;
    MemberId self_ = kHost;
    bool live_ = false;
    bool over_ = false;
    StreamShape shape_;
    std::unique_ptr<Sender> sender_;
    std::map<MemberId, std::unique_ptr<Receiver>> receivers_;
    // Cache of the sender of the last datagram: the next one is usually from the same member.
    struct {
        MemberId from = 0;
        Receiver* receiver = nullptr; // null: look it up
    } active_;
    int64_t receiversDueNs_ = INT64_MIN;     // earliest due time of all receivers
    std::vector<MemberId> touched_;          // receivers with input since the last tick
    std::map<MemberId, MemberInfo> members_; // without this member
    // Reordering guard: a tunnelled datagram that overtakes datagrams still queued in the sockets would mark them as
    // lost. Tunnelled input waits until the sockets are drained, as does later input of connections.
    std::vector<std::pair<MemberId, ControlMessage>> late_;
    int64_t lateSinceNs_ = 0;
    bool anyTunnel_ = false; // at least one member is tunnelled
    int64_t watchedNs_ = INT64_MIN;
    std::map<MemberId, Candidate> candidates_;
    std::map<MemberId, Unreached> unreached_;
    bool tunnelled_ = false; // this member is tunnelled
    bool unshown_ = false;   // tunnelled since joining, without any multicast so far
    uint32_t probeNonce_ = 0;
    uint32_t nextId_ = 1; // ids are never reused: a key must not repeat counters
    int64_t probedNs_ = INT64_MIN;
    uint32_t dropped_ = 0;
};

} // namespace mural::rsp
