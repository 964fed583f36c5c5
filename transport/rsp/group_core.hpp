// One process's place in a group: who is in it, its own stream to all, and everyone's stream to it. Pure as Sender and
// Receiver are: messages, datagrams and times come in; messages, datagrams and events go out.
//
// One member is the host. All others have a control connection to it, over which they join, learn of each other, and send
// what datagrams can't reach. A member that comes is shown a probe by multicast; if it does not see one in time, its
// datagrams go through the control connection (a tunnel) instead: same sequences, same windows, nobody else is slower. Where
// that was the control connection's lateness, the first full datagram of the stream shows it, and the tunnel ends.
//
// host:     Join → Welcome → probes … Probed, or late → MemberCame to all, and all others to the new one
// members:  MemberCame → their stream begins for that member → StreamStart, through the host
#pragma once

#include <deque>
#include <memory>

#include "transport/rsp/control_message.hpp"
#include "transport/rsp/receiver.hpp"
#include "transport/rsp/sender.hpp"

namespace mural::rsp {

constexpr MemberId kHost = 0;
constexpr int64_t kBetweenProbesNs = 50'000'000;
constexpr int64_t kMostLateNs = 100'000'000;     // how long a connection may wait for the sockets
constexpr int64_t kBetweenWatchesNs = 5'000'000; // whether members are silent, or stalled
constexpr size_t kProbeHeadBytes = kHeadBytes + 4; // and the nonce; the rest fills the datagram up

// What is done about a member that the stream waits for.
enum class StallPolicy : uint8_t {
    Wait,  // for ever: as the thesis' protocol
    Eject, // it is removed, and may come again
};

struct GroupSettings {
    bool host = false;
    Uuid uuid{};
    bool multicast = true;      // this member wants it
    uint16_t udpPort = 0;       // of its own socket
    uint32_t socketDatagrams = 4096;
    uint16_t mostDatagramBytes = 1472;
    uint8_t seals = 0xff;       // that it can do
    RateSettings rate;
    bool parity = true;
    int64_t heartbeatNs = 100'000'000; // of the host's stream: by its words, and by those about it, everybody is watched
    int64_t memberHeartbeatNs = 1'000'000'000; // of all others' streams, each of which has as many readers
    // The host's:
    std::string group;
    SessionKeys keys;
    uint16_t datagramBytes = 1472;
    uint32_t windowDatagrams = 4096;
    StallPolicy stalled = StallPolicy::Eject;
    int64_t stalledNs = 2'000'000'000;
    int64_t silentNs = 1'000'000'000;
    int64_t probeNs = 300'000'000; // how long a member may take to see a probe
    uint32_t firstSequence = 0;
    uint32_t probeSeed = 1;
};

struct MemberInfo {
    Uuid uuid{};
    std::string name;    // by which it showed that it knows the secret; only the host knows it
    std::string address; // as the host sees it
    uint16_t udpPort = 0;
    bool multicast = false;
    uint64_t fromByte = 0; // of this process's own stream: the first one that it gets
};

// What the group wants done outside.
class GroupOutput {
public:
    GroupOutput() = default;
    GroupOutput(const GroupOutput&) = delete;
    GroupOutput& operator=(const GroupOutput&) = delete;
    virtual ~GroupOutput() = default;

    // Over the control connection of a member (host), or to the host (member: kHost).
    virtual void control(MemberId to, const ControlMessage& message) = 0;
    // A datagram of so many bytes to the group or one member, as Outbox. Filled before the next call.
    virtual std::span<std::byte> datagram(MemberId to, size_t bytes) = 0;
    // Sockets have datagrams that were not yet input, and that may have been sent before what a connection brings now.
    virtual bool behind() = 0;
    // This member knows the session: sockets and keys can be made.
    virtual void welcomed(const Welcome& w) = 0;
    virtual void memberCame(MemberId id, const MemberInfo& info) = 0;
    virtual void memberGone(MemberId id, GoneReason reason) = 0;
    // Multicast does not reach it any longer, and it goes on through its control connection; or it does again.
    virtual void memberRerouted(MemberId id, bool multicast) = 0;
    // The control connection is to be ended.
    virtual void hangUp(MemberId id, const std::string& why) = 0;
};

class GroupCore {
public:
    GroupCore(const GroupSettings& settings, GroupOutput& out);
    ~GroupCore();

    // Member: the control connection is open.
    void begin();
    // Host: a control connection is open; returns the id it is known by from now on; nothing when there are no more ids.
    std::optional<MemberId> connected(const std::string& address, const std::string& name, int64_t nowNs);
    // The control connection has ended (host: of that member).
    void disconnected(MemberId id, int64_t nowNs);
    void inputControl(MemberId from, const ControlMessage& message, int64_t nowNs);
    // Where datagrams of the stream that was heard last are wanted, of what comes to the group.
    Landing landing();
    // Opened already.
    void inputDatagram(std::span<const std::byte> datagram, int64_t nowNs);
    void socketDropped(uint32_t count);
    int64_t tick(int64_t nowNs);
    // Host: nobody waits for it any longer, and it learns so.
    void expel(MemberId id, GoneReason reason, const std::string& why);

    // This one's own stream. There is none before the group has taken us in.
    [[nodiscard]] Sender* sender() { return sender_.get(); }
    // Another member's stream; nullptr: none (yet). It stays when the member has gone, until it is forgotten: what came
    // can still be read.
    // What is read there may be worth telling: the next tick looks.
    [[nodiscard]] Receiver* receiver(MemberId from);
    void forget(MemberId from) {
        heard_ = {};
        receivers_.erase(from);
    }
    [[nodiscard]] const std::map<MemberId, MemberInfo>& members() const { return members_; }
    [[nodiscard]] bool live() const { return live_; }
    [[nodiscard]] bool over() const { return over_; } // the host is gone, or has refused us
    [[nodiscard]] MemberId self() const { return self_; }

private:
    // Host: who has connected and is not yet one of the group.
    struct Candidate {
        std::string address;
        std::string name;
        Join join;
        bool joined = false;
        uint32_t nonce = 0;
        int64_t untilNs = 0;
    };
    // Host: whom multicast does not reach. It is tried again now and then.
    struct Unreached {
        uint32_t nonce = 0;
        int64_t againNs = 0; // the next probe
        int64_t waitNs = 0;  // until the one after it; grows each time that it ceases to be reached
        int64_t soonNs = 0;  // instead, while it is shorter
        std::optional<int64_t> silentSinceNs; // why it is taken for unreached, until something is heard of it
    };
    class Datagrams; // the Outbox that knows the tunnels

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
    void meet(MemberId id, MemberInfo info, int64_t nowNs);
    void part(MemberId id, GoneReason reason);
    void remove(MemberId id, GoneReason reason);
    void makeSender();
    [[nodiscard]] int64_t heartbeatNs(MemberId writer) const { return writer == kHost ? settings_.heartbeatNs : settings_.memberHeartbeatNs; }
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
    // Whom the last datagram of a stream was of, a member: most are followed by another one of it.
    struct {
        MemberId from = 0;
        Receiver* receiver = nullptr; // nullptr: to be looked up
    } heard_;
    int64_t receiversDueNs_ = INT64_MIN; // the first of them that something is due at
    std::vector<MemberId> touched_;      // receivers that something has come for since the last tick
    std::map<MemberId, MemberInfo> members_; // without this one
    // A tunnelled datagram that overtook those in the sockets would make all of them lost: who was stopped for a while finds
    // both. It waits, and what comes behind it by a connection too.
    std::vector<std::pair<MemberId, ControlMessage>> late_;
    int64_t lateSinceNs_ = 0;
    bool anyTunnel_ = false;                 // multicast does not reach all of them
    int64_t watchedNs_ = INT64_MIN;
    std::map<MemberId, Candidate> candidates_;
    std::map<MemberId, Unreached> unreached_;
    bool tunnelled_ = false; // this member is reached by the control connection alone
    bool unshown_ = false;   // it was so from the beginning, and nothing has come by multicast yet
    uint32_t probeNonce_ = 0;
    uint32_t nextId_ = 1; // no id comes twice: its key would be used with the same counters again
    int64_t probedNs_ = INT64_MIN;
    uint32_t dropped_ = 0;
};

} // namespace mural::rsp
