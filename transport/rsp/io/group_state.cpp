#include "transport/rsp/io/group_state.hpp"

#include <algorithm>
#include <cstring>
#include <netinet/in.h>
#include <sodium.h>

#include <boost/asio/post.hpp>

#include "common/log/log.hpp"
#include "transport/tcp/tcp_address.hpp"
#include "transport/tcp/tcp_race.hpp"

namespace mural::rsp {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr double kShareOfLink = 0.9;
constexpr size_t kMaxWindowsWaiting = 2; // queued in a member's connection, per stream
constexpr int64_t kGoodbyeMs = 1000;     // longest wait of a leaving member for acknowledgement
constexpr size_t kUdpOverIpv4Bytes = 28;
constexpr size_t kUdpOverIpv6Bytes = 48;

int64_t steadyNs() { return quickNowNs(); }

const char* wayOf(bool multicast) { return multicast ? "multicast" : "its control connection"; }

// Members other than the host do not know the names of each other.
std::string memberText(MemberId id, const MemberInfo& info) {
    return "member " + std::to_string(id) + (info.name.empty() ? "" : " (" + info.name + ")");
}

const char* textOf(GoneReason reason) {
    switch (reason) {
    case GoneReason::Left: return "it left";
    case GoneReason::Cut: return "its control connection ended";
    case GoneReason::Silent: return "silent";
    case GoneReason::Stalled: return "stalled";
    case GoneReason::Removed: break;
    }
    return "removed";
}

// Removes the mapping prefix: an IPv4 peer of an IPv6 socket appears as "::ffff:10.0.0.1".
std::string withoutMapping(const std::string& address) {
    constexpr std::string_view kMapping = "::ffff:";
    return address.starts_with(kMapping) ? address.substr(kMapping.size()) : address;
}

} // namespace

Group::State::State(const GroupOptions& options) : options_(options) {}

Group::State::~State() { stop(); }

Result<void> Group::State::openSockets() {
    auto group = numericEndpoint(options_.group);
    if (!group) return group.error();
    group_ = *group;
    auto interface = findInterface(options_.interface, group_.family());
    if (!interface) return interface.error();
    interface_ = *interface;
    if (auto all = networkInterfaces()) {
        for (const NetworkInterface& i : *all)
            for (const SocketAddress& a : i.addresses) ownAddresses_.insert(numericText(a));
    }
    auto own = UdpSocket::openOwn(interface_, group_.family(), options_.socketBytes);
    if (!own) return own.error();
    own_.emplace(std::move(*own));
    own_->omitSenders(); // datagrams identify their sender
    auto arrivals = SocketPoller::open();
    if (!arrivals) return arrivals.error();
    arrivals_.emplace(std::move(*arrivals));
    if (auto r = arrivals_->add(own_->descriptor()); !r) return r.error();
    watched_.emplace(context_, arrivals_->watched());
    auto takeOver = HandoverTimer::open();
    if (!takeOver) return takeOver.error();
    takeOver_.emplace(std::move(*takeOver));
    takeOverRings_.emplace(context_, takeOver_->descriptor());
    outbox_.emplace(*own_);
    outbox_->setGroup(group_);
    return {};
}

Result<void> Group::State::joinMulticast() {
    auto socket = UdpSocket::openGroup(group_, interface_, options_.socketBytes);
    if (!socket) return socket.error();
    groupSocket_.emplace(std::move(*socket));
    groupSocket_->omitSenders();
    return arrivals_->add(groupSocket_->descriptor());
}

Result<void> Group::State::openCore(bool isHost) {
    if (sodium_init() < 0) return Error{"libsodium cannot generate random numbers"};
    GroupSettings s;
    s.host = isHost;
    randombytes_buf(s.uuid.data(), s.uuid.size());
    randombytes_buf(&s.firstSequence, sizeof s.firstSequence);
    randombytes_buf(&s.probeSeed, sizeof s.probeSeed);
    s.multicast = options_.multicast;
    s.udpPort = tcpPort(own_->localAddress());
    const size_t overhead = group_.family() == AF_INET ? kUdpOverIpv4Bytes : kUdpOverIpv6Bytes;
    const size_t maximum = std::min(interface_.mtuBytes - overhead, kMaxDatagramBytes);
    s.maxDatagramBytes = static_cast<uint16_t>(maximum);
    s.datagramBytes = static_cast<uint16_t>(options_.datagramBytes != 0 ? options_.datagramBytes : maximum);
    s.socketDatagrams = own_->capacity(s.datagramBytes);
    moderation_ = ReceiveModeration(s.socketDatagrams);
    s.seals = 0;
    for (const Seal seal : {Seal::None, Seal::Tag, Seal::AesGcm, Seal::ChaCha})
        if (available(seal)) s.seals |= static_cast<uint8_t>(1 << static_cast<int>(seal));
    s.group = options_.group;
    if (isHost) s.keys = makeSessionKeys(options_.seal);
    s.windowDatagrams = options_.windowDatagrams;
    windowBytes_ = size_t{s.windowDatagrams} * s.datagramBytes;
    s.rate.maxBytesPerS = options_.bytesPerS > 0 ? options_.bytesPerS : kShareOfLink * interface_.bytesPerS;
    s.parity = options_.parity;
    s.stalled = options_.stalled;
    s.stalledNs = options_.stalledMs * kNsPerMs;
    s.silentNs = options_.silentMs * kNsPerMs;
    s.probeNs = options_.probeMs * kNsPerMs;
    if (isHost) {
        outbox_->useKeys(s.keys, kHost);
        opener_.emplace(s.keys);
        log::debug(log::Topic::Rsp, "host of ", s.group, " on ", interface_.name, ": datagrams of ", s.datagramBytes,
                   " bytes, a window of ", s.windowDatagrams, ", rate limit ", s.rate.maxBytesPerS / 1e6,
                   " MB/s (0: none), ", nameOf(options_.seal));
    }
    core = std::make_unique<GroupCore>(s, *this);
    return {};
}

Result<void> Group::State::openHost() {
    if (auto r = openSockets(); !r) return r.error();
    // The host receives the other members' streams too.
    if (auto r = joinMulticast(); !r) return r.error();
    if (auto r = openCore(true); !r) return r.error();
    ignoreOwn();
    auto where = splitHostPort(options_.control);
    if (!where) return where.error();
    error_code failed;
    const auto address = where->host.empty() ? asio::ip::address(asio::ip::address_v6::any())
                                             : asio::ip::make_address(where->host, failed);
    if (failed) return Error{"\"" + where->host + "\" is not an address to listen on; use a numeric address"};
    try {
        acceptor_.emplace(context_, Tcp::endpoint(address, where->port));
        controlAddress = tcpText(localTcpAddress(acceptor_->native_handle())).substr(std::strlen("tcp://"));
    } catch (const boost::system::system_error& e) {
        return Error{"cannot listen at " + options_.control + ": " + e.code().message()};
    }
    acceptLinks();
    startThread();
    return {};
}

Result<void> Group::State::openMember(Deadline deadline) {
    if (auto r = openSockets(); !r) return r.error();
    if (auto r = openCore(false); !r) return r.error();
    auto where = splitHostPort(options_.control);
    if (!where) return where.error();
    auto addresses = resolveTcp(where->host, where->port, TcpRole::Connect, deadline);
    if (!addresses) return addresses.error();
    auto connected = connectRacing(*addresses, deadline);
    if (!connected)
        return Error{"cannot connect to the group's host at " + options_.control + ": " + connected.error().message};
    const bool isIpv4 = localTcpAddress(connected->get()).family() == AF_INET;
    Tcp::socket socket(context_, isIpv4 ? Tcp::v4() : Tcp::v6(), connected->release());
    auto link =
        std::make_shared<ControlLink>(std::move(socket), SecureChannel::connecting(options_.name, options_.secret));
    hostAddress_ = link->peerAddress();
    log::debug(log::Topic::Rsp, "joins the group at ", options_.control, " on ", interface_.name);
    asio::post(context_, [this, link] { startLink(kHost, link); });
    startThread();
    return {};
}

void Group::State::startThread() {
    asio::post(context_, [this] {
        watch();
        watchLeaders();
        const std::lock_guard lock(mutex);
        pump();
    });
    thread_ = std::thread([this] {
        const auto work = asio::make_work_guard(context_);
        context_.run();
    });
}

void Group::State::stop() {
    if (thread_.joinable()) {
        asio::post(context_, [this] {
            {
                const std::lock_guard lock(mutex);
                fail("this member has left the group");
                if (links_.contains(kHost)) links_.at(kHost)->send(Leave{});
            }
            if (acceptor_) acceptor_->close();
            for (const auto& [id, link] : links_) link->hangUp();
            for (const auto& link : strangers_) link->hangUp();
            endAfterGoodbyes(Deadline::inMs(kGoodbyeMs));
        });
        thread_.join();
    }
    // Release the descriptors: they have another owner.
    for (auto* borrowed : {&watched_, &takeOverRings_}) {
        if (*borrowed) (*borrowed)->release();
        borrowed->reset();
    }
}

// Waits until the goodbyes are delivered or time out.
void Group::State::endAfterGoodbyes(Deadline deadline) {
    const bool all = std::ranges::all_of(links_, [](const auto& l) { return l.second->ended(); });
    if (all || deadline.passed()) return context_.stop();
    goodbyeTimer_.expires_after(std::chrono::milliseconds(2));
    goodbyeTimer_.async_wait([this, deadline](const error_code&) { endAfterGoodbyes(deadline); });
}

void Group::State::fail(const std::string& why) {
    if (failure.empty()) {
        failure = why.empty() ? "the group's host has ended the group" : why;
        log::debug(log::Topic::Rsp, "the group ends: ", failure);
    }
    wakeAll();
}

void Group::State::acceptLinks() {
    acceptor_->async_accept([this](const error_code& failed, Tcp::socket socket) {
        if (failed == asio::error::operation_aborted) return;
        if (!failed) {
            const ChannelSecret secret = options_.secret;
            auto channel = SecureChannel::accepting([secret](const std::string&) { return std::optional(secret); });
            auto link = std::make_shared<ControlLink>(std::move(socket), std::move(channel));
            strangers_.insert(link);
            const auto id = std::make_shared<std::optional<MemberId>>();
            ControlLink::Events events;
            events.opened = [this, link, id] {
                strangers_.erase(link);
                const std::lock_guard lock(mutex);
                *id = core->connected(link->peerAddress(), link->name(), steadyNs());
                if (*id) links_[**id] = link;
                updateLoop();
            };
            events.message = [this, id](const ControlMessage& m) {
                if (!*id) return;
                const std::lock_guard lock(mutex);
                core->inputControl(**id, m, steadyNs());
                pump();
            };
            events.closed = [this, link, id](const std::string&) {
                strangers_.erase(link);
                if (!*id) return;
                const std::lock_guard lock(mutex);
                links_.erase(**id);
                core->disconnected(**id, steadyNs());
                pump();
            };
            link->start(std::move(events));
        }
        acceptLinks();
    });
}

// Member: starts the link to the host.
void Group::State::startLink(MemberId id, const std::shared_ptr<ControlLink>& link) {
    {
        const std::lock_guard lock(mutex);
        links_[id] = link;
    }
    ControlLink::Events events;
    events.opened = [this] {
        const std::lock_guard lock(mutex);
        core->begin();
    };
    events.message = [this](const ControlMessage& m) {
        const std::lock_guard lock(mutex);
        core->inputControl(kHost, m, steadyNs());
        if (core->over()) fail("the group's host has evicted this member; join again");
        pump();
        changed.notify_all();
    };
    events.closed = [this](const std::string& why) {
        const std::lock_guard lock(mutex);
        links_.clear();
        core->disconnected(kHost, steadyNs());
        hostLeft = why.empty() && failure.empty();
        fail(why.empty() || !failure.empty() ? why : "the connection to the group's host was lost: " + why);
    };
    link->start(std::move(events));
}

// Disables multicast loopback while no member runs on this machine.
void Group::State::updateLoop() {
    const auto isHere = [&](const std::string& address) { return ownAddresses_.contains(withoutMapping(address)); };
    bool any = !hostAddress_.empty() && isHere(hostAddress_);
    for (const auto& [id, link] : links_) any = any || isHere(link->peerAddress());
    for (const auto& [id, info] : core->members()) any = any || isHere(info.address);
    if (any == std::exchange(loop_, any)) return;
    own_->setLoop(any);
    ignoreOwn();
}

void Group::State::ignoreOwn() {
    if (!groupSocket_) return;
    if (loop_)
        groupSocket_->ignoreMember(core->self());
    else
        groupSocket_->ignoreNobody();
}

// Drops of looped-back own datagrams are not losses.
uint32_t Group::State::dropped() const {
    return own_->dropped() + (groupSocket_ && !loop_ ? groupSocket_->dropped() : 0);
}

// Bounds the queue of a connection to a window of each stream and its repairs. A partially reachable member may already
// have acknowledged queued data; over a slower connection the queue would never drain. Excess datagrams are dropped and
// repaired, as on any congested path.
void Group::State::sendControl(MemberId to, const ControlMessage& message) {
    const auto found = links_.find(to);
    if (found == links_.end()) return;
    if (std::holds_alternative<Tunnel>(message))
        found->second->offer(message, kMaxWindowsWaiting * windowBytes_ * links_.size());
    else
        found->second->send(message);
}

// May be called from any thread. The links belong to the group's thread and change under the lock.
void Group::State::control(MemberId to, const ControlMessage& message) {
    asio::post(context_, [this, to, message] { sendControl(to, message); });
}

std::span<std::byte> Group::State::datagram(MemberId to, size_t bytes) { return outbox_->datagram(to, bytes); }

void Group::State::welcomed(const Welcome& w) {
    if (auto group = numericEndpoint(w.group)) group_ = *group;
    windowBytes_ = size_t{w.windowDatagrams} * w.datagramBytes;
    outbox_->setGroup(group_);
    outbox_->useKeys(w.keys, w.self);
    opener_.emplace(w.keys);
    opener_->addMember(kHost);
    // If joining fails, no probe arrives, and the host uses the connection.
    const auto joined = options_.multicast ? joinMulticast() : Result<void>(Error{"it is not wanted"});
    log::debug(log::Topic::Rsp, "member ", w.self, " of ", w.group, ", window of ", w.windowDatagrams, " datagrams; ",
               joined ? "listens to multicast" : "no multicast: " + joined.error().message);
    if (joined) ignoreOwn();
}

void Group::State::memberCame(MemberId id, const MemberInfo& info) {
    opener_->addMember(id);
    const std::string& host = info.address.empty() ? hostAddress_ : info.address;
    if (auto address = numericAddress(withoutMapping(host), info.udpPort)) {
        outbox_->setMember(id, *address);
    }
    known_[id] = info;
    log::debug(log::Topic::Rsp, memberText(id, info), " at ", withoutMapping(host), " joined; it receives by ",
               wayOf(info.multicast));
    note({MemberEvent::Kind::Came, id, info, {}});
    updateLoop();
    changed.notify_all();
}

// Bounded, because the events may never be queried: drops the oldest.
void Group::State::note(const MemberEvent& event) {
    constexpr size_t kMaxEvents = 4096;
    if (unreadEvents.size() >= kMaxEvents) unreadEvents.erase(unreadEvents.begin());
    unreadEvents.push_back(event);
}

void Group::State::memberRerouted(MemberId id, bool multicast) {
    known_[id].multicast = multicast;
    log::debug(log::Topic::Rsp, memberText(id, known_[id]), " receives by ", wayOf(multicast), " from now on");
    note({MemberEvent::Kind::Rerouted, id, known_[id], {}});
    if (!multicast) return;
    // Queued datagrams are outdated: a member that was stopped has them in its socket buffer, and others are repaired.
    asio::post(context_, [this, id] {
        if (const auto found = links_.find(id); found != links_.end()) found->second->dropOffered();
    });
}

void Group::State::memberGone(MemberId id, GoneReason reason) {
    log::debug(log::Topic::Rsp, memberText(id, known_[id]), " is gone: ", textOf(reason));
    note({MemberEvent::Kind::Gone, id, known_[id], reason});
    known_.erase(id);
    opener_->removeMember(id);
    outbox_->removeMember(id);
    updateLoop();
    wake(data);
    changed.notify_all();
}

void Group::State::hangUp(MemberId id, const std::string& why) {
    if (!core || id == kHost) fail(why);
    asio::post(context_, [this, id] {
        std::shared_ptr<ControlLink> link;
        {
            const std::lock_guard lock(mutex);
            if (auto found = links_.extract(id)) link = std::move(found.mapped());
        }
        if (link) link->hangUp();
    });
}

GroupReport Group::State::report() const {
    GroupReport r;
    if (const Sender* s = core->sender()) {
        r.sender = s->counters();
        r.bytesPerS = s->rate().limited() ? s->rate().bytesPerS() : 0;
        for (const auto& [id, state] : s->members()) {
            const auto info = core->members().find(id);
            r.members.push_back(
                {id, info == core->members().end() ? MemberInfo{} : info->second, state, s->waitsFor(state)});
        }
    }
    if (opener_) r.refused = opener_->refused();
    r.sendings = outbox_->sendings();
    r.sendingBy = own_->sendingBy();
    r.socketDropped = dropped();
    for (const auto& [id, info] : core->members()) {
        if (const Receiver* receiver = core->receiver(id))
            r.streams.push_back({id, receiver->counters(), receiver->lost(), receiver->feedbackSent()});
    }
    return r;
}

} // namespace mural::rsp
