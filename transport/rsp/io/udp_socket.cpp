#include "transport/rsp/io/udp_socket.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <netinet/udp.h>
#include <sys/socket.h>

#include "transport/system_error.hpp"
#include "transport/tcp/tcp_address.hpp"

#ifndef UDP_SEGMENT
#define UDP_SEGMENT 103
#endif
#ifndef UDP_GRO
#define UDP_GRO 104
#endif

namespace mural::rsp {

namespace {

constexpr size_t kSlotBytes = 65'536; // largest result of UDP_GRO
// Offset between slots: with a power of two all first datagrams would share a few cache sets.
constexpr size_t kSlotStrideBytes = kSlotBytes + 1536;
// Overhead of a datagram in the socket buffer: the kernel rounds allocations up to powers of two, plus headers,
// fragments and metadata.
constexpr size_t kPacketRoomBytes = 448;
constexpr size_t kPacketDescriptorBytes = 256;
// Number of reads with several single datagrams after which GRO counts as absent.
constexpr size_t kSeveral = 8;
constexpr size_t kProofDatagrams = 256;

template <class T> bool set(int fd, int level, int option, T value) {
    return setsockopt(fd, level, option, &value, sizeof value) == 0;
}

Error failed(const std::string& what) { return Error{"cannot " + what + ": " + errnoText(errno)}; }

Result<void> chooseInterface(int fd, const NetworkInterface& interface, int family) {
    bool good = false;
    if (family == AF_INET) {
        ip_mreqn request{};
        request.imr_ifindex = static_cast<int>(interface.index);
        good = set(fd, IPPROTO_IP, IP_MULTICAST_IF, request) && set(fd, IPPROTO_IP, IP_MULTICAST_LOOP, 1) &&
               set(fd, IPPROTO_IP, IP_MULTICAST_TTL, 1) && set(fd, IPPROTO_IP, IP_MTU_DISCOVER, IP_PMTUDISC_DO);
    } else {
        good = set(fd, IPPROTO_IPV6, IPV6_MULTICAST_IF, interface.index) &&
               set(fd, IPPROTO_IPV6, IPV6_MULTICAST_LOOP, 1) && set(fd, IPPROTO_IPV6, IPV6_MULTICAST_HOPS, 1) &&
               set(fd, IPPROTO_IPV6, IPV6_MTU_DISCOVER, IPV6_PMTUDISC_DO);
    }
    if (!good) return failed("send multicast through network interface " + interface.name);
    return {};
}

Result<void> joinGroup(int fd, const SocketAddress& group, const NetworkInterface& interface) {
    group_req request{};
    request.gr_interface = interface.index;
    std::memcpy(&request.gr_group, &group.storage, group.sizeBytes);
    const int level = group.family() == AF_INET ? IPPROTO_IP : IPPROTO_IPV6;
    if (!set(fd, level, MCAST_JOIN_GROUP, request)) return failed("join the multicast group on " + interface.name);
    return {};
}

} // namespace

struct UdpSocket::Slots {
    // Memory is committed on first use; most of it never is.
    std::unique_ptr<std::byte[]> bytes = std::make_unique_for_overwrite<std::byte[]>(kMaxAtOnce * kSlotStrideBytes);
    std::array<mmsghdr, kMaxAtOnce> messages{};
    std::array<iovec, kMaxAtOnce> pieces{}; // one per message: more would cost the kernel 55 ns per datagram
    std::array<SocketAddress, kMaxAtOnce> from{};
    std::array<std::array<char, 128>, kMaxAtOnce> control{};

    bool plain = false; // each message has a buffer and no metadata

    void prepare(bool reportsSenders, const ReceiveBuffers& landing) {
        const bool wantsPlain = !reportsSenders && landing.buffers.size() == kMaxAtOnce;
        // the kernel leaves these fields unchanged
        if (plain && wantsPlain && pieces[0].iov_len == landing.bufferBytes) {
            for (size_t i = 0; i < kMaxAtOnce; ++i) pieces[i].iov_base = landing.buffers[i];
            return;
        }
        plain = wantsPlain;
        for (size_t i = 0; i < kMaxAtOnce; ++i) {
            if (i < landing.buffers.size())
                pieces[i] = {landing.buffers[i], landing.bufferBytes};
            else
                pieces[i] = {bytes.get() + i * kSlotStrideBytes, kSlotBytes};
            msghdr& h = messages[i].msg_hdr;
            h = {};
            h.msg_iov = &pieces[i];
            h.msg_iovlen = 1;
            if (reportsSenders) h.msg_name = &from[i].storage;
            h.msg_namelen = reportsSenders ? sizeof from[i].storage : 0;
            if (plain) continue;
            h.msg_control = control[i].data();
            h.msg_controllen = control[i].size();
        }
    }
};

void UdpSocket::FreeSlots::operator()(Slots* slots) const { delete slots; }

void UdpSocket::prepare(size_t bufferBytes) {
    const int fd = socket_.get();
    const int wanted = static_cast<int>(std::min<size_t>(bufferBytes, size_t{1} << 30));
    // SO_RCVBUFFORCE exceeds the system's limit and requires root.
    if (!set(fd, SOL_SOCKET, SO_RCVBUFFORCE, wanted)) set(fd, SOL_SOCKET, SO_RCVBUF, wanted);
    if (!set(fd, SOL_SOCKET, SO_SNDBUFFORCE, wanted)) set(fd, SOL_SOCKET, SO_SNDBUF, wanted);
    int got = 0;
    socklen_t size = sizeof got;
    if (getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &got, &size) == 0) bufferBytes_ = static_cast<size_t>(got);
    set(fd, IPPROTO_UDP, UDP_GRO, 1);
}

Result<UdpSocket> UdpSocket::openGroup(const SocketAddress& group, const NetworkInterface& interface,
                                       size_t bufferBytes) {
    FileDescriptor fd(::socket(group.family(), SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!fd.valid()) return failed("open a UDP socket");
    UdpSocket socket(std::move(fd));
    socket.prepare(bufferBytes);
    set(socket.descriptor(), SOL_SOCKET, SO_REUSEADDR, 1);
    SocketAddress field = group;
    // A link-local IPv6 group exists once per interface.
    if (auto* six = reinterpret_cast<sockaddr_in6*>(&field.storage);
        field.family() == AF_INET6 && IN6_IS_ADDR_MC_LINKLOCAL(&six->sin6_addr))
        six->sin6_scope_id = interface.index;
    if (bind(socket.descriptor(), field.get(), field.sizeBytes) != 0)
        return failed("bind to the multicast group's port " + std::to_string(tcpPort(group)));
    if (auto r = joinGroup(socket.descriptor(), group, interface); !r) return r.error();
    // Receive from this interface only.
    set(socket.descriptor(), IPPROTO_IP, IP_MULTICAST_ALL, 0);
    return socket;
}

Result<UdpSocket> UdpSocket::openOwn(const NetworkInterface& interface, int family, size_t bufferBytes) {
    FileDescriptor fd(::socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!fd.valid()) return failed("open a UDP socket");
    UdpSocket socket(std::move(fd));
    socket.prepare(bufferBytes);
    if (auto r = chooseInterface(socket.descriptor(), interface, family); !r) return r.error();
    const SocketAddress* own = interface.address(family);
    if (!own || bind(socket.descriptor(), own->get(), own->sizeBytes) != 0)
        return failed("bind a UDP port on network interface " + interface.name);
    return socket;
}

void UdpSocket::setLoop(bool loop) {
    const int value = loop ? 1 : 0;
    if (!set(socket_.get(), IPPROTO_IP, IP_MULTICAST_LOOP, value))
        set(socket_.get(), IPPROTO_IPV6, IPV6_MULTICAST_LOOP, value);
}

void UdpSocket::ignoreMember(MemberId self) {
    // The datagram's header follows the UDP header (8 bytes), with the member id in its third and fourth byte. BPF
    // loads big-endian.
    constexpr uint32_t field = 8 + 2;
    const auto turned = static_cast<uint32_t>((self & 0xff) << 8 | self >> 8);
    std::array<sock_filter, 4> program{{
        {BPF_LD | BPF_H | BPF_ABS, 0, 0, field},
        {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, turned},
        {BPF_RET | BPF_K, 0, 0, 0},
        {BPF_RET | BPF_K, 0, 0, UINT32_MAX},
    }};
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    // Without the filter the datagrams are rejected later.
    set(socket_.get(), SOL_SOCKET, SO_ATTACH_FILTER, filter);
}

void UdpSocket::ignoreNobody() { set(socket_.get(), SOL_SOCKET, SO_DETACH_FILTER, 0); }

SocketAddress UdpSocket::localAddress() const { return localTcpAddress(socket_.get()); }

uint32_t UdpSocket::capacity(size_t datagramBytes) const {
    const size_t each = std::bit_ceil(datagramBytes + kPacketRoomBytes) + kPacketDescriptorBytes;
    return static_cast<uint32_t>(std::max<size_t>(1, bufferBytes_ / each));
}

// Queries the counter. Receiving it with each datagram (SO_RXQ_OVFL) costs a fiftieth of the receive path.
uint32_t UdpSocket::dropped() const {
    std::array<uint32_t, SK_MEMINFO_VARS> counters{};
    socklen_t size = sizeof counters;
    if (getsockopt(socket_.get(), SOL_SOCKET, SO_MEMINFO, counters.data(), &size) != 0) return 0;
    return counters[SK_MEMINFO_DROPS];
}

const char* UdpSocket::sendingBy() const {
    return sending_ == Sending::Segments ? "UDP_SEGMENT" : sending_ == Sending::Several ? "sendmmsg" : "sendto";
}

int UdpSocket::sendSegments(const SocketAddress& to, std::span<std::byte> datagrams, size_t segmentBytes) const {
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(uint16_t))> control{};
    iovec piece{datagrams.data(), datagrams.size()};
    msghdr message{};
    message.msg_name = const_cast<sockaddr*>(to.get());
    message.msg_namelen = to.sizeBytes;
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    if (datagrams.size() > segmentBytes) {
        message.msg_control = control.data();
        message.msg_controllen = control.size();
        cmsghdr* c = CMSG_FIRSTHDR(&message);
        c->cmsg_level = IPPROTO_UDP;
        c->cmsg_type = UDP_SEGMENT;
        c->cmsg_len = CMSG_LEN(sizeof(uint16_t));
        const auto bytes = static_cast<uint16_t>(segmentBytes);
        std::memcpy(CMSG_DATA(c), &bytes, sizeof bytes);
    }
    return sendmsg(socket_.get(), &message, 0) < 0 ? errno : 0;
}

int UdpSocket::sendSeveral(const SocketAddress& to, std::span<std::byte> datagrams, size_t segmentBytes) const {
    std::array<mmsghdr, kMaxInSending> messages{};
    std::array<iovec, kMaxInSending> pieces{};
    unsigned count = 0;
    for (size_t at = 0; at < datagrams.size(); at += segmentBytes, ++count) {
        pieces[count] = {datagrams.data() + at, std::min(segmentBytes, datagrams.size() - at)};
        msghdr& h = messages[count].msg_hdr;
        h.msg_name = const_cast<sockaddr*>(to.get());
        h.msg_namelen = to.sizeBytes;
        h.msg_iov = &pieces[count];
        h.msg_iovlen = 1;
    }
    for (unsigned sent = 0; sent < count;) {
        const int n = sendmmsg(socket_.get(), messages.data() + sent, count - sent, 0);
        if (n < 0) return errno;
        sent += static_cast<unsigned>(n);
    }
    return 0;
}

int UdpSocket::sendSingle(const SocketAddress& to, std::span<std::byte> datagrams, size_t segmentBytes) const {
    for (size_t at = 0; at < datagrams.size(); at += segmentBytes) {
        const size_t bytes = std::min(segmentBytes, datagrams.size() - at);
        if (sendto(socket_.get(), datagrams.data() + at, bytes, 0, to.get(), to.sizeBytes) < 0) return errno;
    }
    return 0;
}

Result<void> UdpSocket::send(const SocketAddress& to, std::span<std::byte> datagrams, size_t segmentBytes) {
    while (true) {
        int code = 0;
        switch (sending_) {
        case Sending::Segments: code = sendSegments(to, datagrams, segmentBytes); break;
        case Sending::Several: code = sendSeveral(to, datagrams, segmentBytes); break;
        case Sending::Single: code = sendSingle(to, datagrams, segmentBytes); break;
        }
        switch (code) {
        case 0:
        case EAGAIN:
        case ENOBUFS:
        case ENOMEM:
        case ECONNREFUSED: return {}; // counts as lost; the error belongs to an earlier datagram to a closed port
        case EINTR: continue;
        case EIO:
        case EINVAL:
        case EOPNOTSUPP:
        case ENOPROTOOPT:
            if (sending_ == Sending::Segments) {
                sending_ = Sending::Several;
                continue;
            }
            break;
        case ENOSYS:
            if (sending_ == Sending::Several) {
                sending_ = Sending::Single;
                continue;
            }
            break;
        default: break;
        }
        return Error{"cannot send datagrams of " + std::to_string(segmentBytes) + " bytes: " + errnoText(code)};
    }
}

std::span<const UdpSocket::Datagram> UdpSocket::fetch(const ReceiveBuffers& landing) {
    if (!slots_) slots_.reset(new Slots); // not needed by sending-only sockets
    Slots& s = *slots_;
    // Coalesced datagrams need more room than a slot has.
    s.prepare(reportsSenders_, joined_ == Joined::Never ? landing : ReceiveBuffers{});
    const int count = recvmmsg(socket_.get(), s.messages.data(), kMaxAtOnce, MSG_DONTWAIT, nullptr);
    const auto messages = static_cast<size_t>(std::max(0, count));
    mayBeMore_ = messages == kMaxAtOnce;
    fetched_.clear();
    for (size_t i = 0; i < messages; ++i) {
        msghdr& h = s.messages[i].msg_hdr;
        const size_t bytes = s.messages[i].msg_len;
        size_t segment = bytes;
        for (cmsghdr* c = CMSG_FIRSTHDR(&h); c; c = CMSG_NXTHDR(&h, c)) {
            if (c->cmsg_level == IPPROTO_UDP && c->cmsg_type == UDP_GRO) {
                int value = 0;
                std::memcpy(&value, CMSG_DATA(c), sizeof value);
                if (value > 0) segment = static_cast<size_t>(value);
            }
        }
        if ((h.msg_flags & MSG_TRUNC) != 0) continue;
        if (reportsSenders_) s.from[i].sizeBytes = h.msg_namelen;
        auto* const data = static_cast<std::byte*>(s.pieces[i].iov_base);
        for (size_t at = 0; at < bytes; at += segment)
            fetched_.push_back({{data + at, std::min(segment, bytes - at)}, &s.from[i]});
    }
    if (joined_ == Joined::Unknown) detectCoalescing(messages, fetched_.size(), !landing.buffers.empty());
    return fetched_;
}

// Detects GRO from the first burst: with it, coalescing saves more than the copy costs; without it, datagrams are
// received in place.
void UdpSocket::detectCoalescing(size_t messages, size_t datagrams, bool wantsLanding) {
    if (datagrams > messages)
        joined_ = Joined::Some;
    else if (messages >= kSeveral)
        single_ += messages;
    if (joined_ != Joined::Unknown || single_ < kProofDatagrams || !wantsLanding) return;
    set(socket_.get(), IPPROTO_UDP, UDP_GRO, 0);
    joined_ = Joined::Never;
}

} // namespace mural::rsp
