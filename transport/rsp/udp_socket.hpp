// UDP as RSP needs it: many datagrams per system call, and what the kernel dropped.
//
// Sending: up to 64 datagrams of one size go out as one (UDP_SEGMENT); where a kernel or card refuses that, by sendmmsg;
// where that is missing, one by one. What was refused once is not tried again. Receiving: recvmmsg, and UDP_GRO where
// cards join datagrams; where they join none, each lands where its reader wants it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "transport/file_descriptor.hpp"
#include "transport/rsp/datagram.hpp"
#include "transport/rsp/landing.hpp"
#include "transport/rsp/network_interface.hpp"
#include "transport/rsp/outbox.hpp"
#include "transport/socket_address.hpp"

namespace mural::rsp {

class UdpSocket {
public:
    // For what is sent to the group.
    static Result<UdpSocket> openGroup(const SocketAddress& group, const NetworkInterface& interface, size_t bufferBytes);
    // For sending to the group and to members, and for what is sent to this member alone; any free port.
    static Result<UdpSocket> openOwn(const NetworkInterface& interface, int family, size_t bufferBytes);

    // Whether what is sent to the group comes to members on this machine, too.
    void setLoop(bool loop);
    // What this member sent and what comes back to its own machine: dropped by the kernel, before it takes room here. Every
    // datagram is looked at for that, by whoever brings it: on one machine, its sender.
    void ignoreMember(MemberId self);
    void ignoreNobody();

    // No senders are told: to ask the kernel for their addresses costs something for each datagram.
    void leaveOutSenders() { tellsSenders_ = false; }

    [[nodiscard]] int descriptor() const { return socket_.get(); }
    [[nodiscard]] SocketAddress localAddress() const;

    // Datagrams of segmentBytes each, the last may be shorter; at most mostInSending(). What the network
    // has no room for is lost, as on the way. Errors: the network is gone; the datagrams are too long for it.
    Result<void> send(const SocketAddress& to, std::span<std::byte> datagrams, size_t segmentBytes);

    struct Datagram {
        std::span<std::byte> bytes; // at a place of the landing, or of the socket's own
        const SocketAddress* from;
    };
    // What is there now, by one system call, in its order; it stays until the next call. Once it is clear that nothing comes
    // joined, all lie at the landing's places; what is longer than those is then lost, as on the way.
    std::span<const Datagram> fetch(const Landing& landing = {});
    // The last call took as many as it may.
    [[nodiscard]] bool mayBeMore() const { return mayBeMore_; }

    // So many datagrams were dropped because nobody fetched them. With ignoreMember, those that it drops count, too.
    [[nodiscard]] uint32_t dropped() const;
    // What the kernel gave for receiving; it counts its own bookkeeping in.
    [[nodiscard]] size_t bufferBytes() const { return bufferBytes_; }
    // What the socket's buffer holds of datagrams of a size.
    [[nodiscard]] uint32_t capacity(size_t datagramBytes) const;
    [[nodiscard]] const char* sendingBy() const;

private:
    enum class Sending { Segments, Several, Single };
    enum class Joined { Unknown, Some, Never };
    explicit UdpSocket(FileDescriptor socket) : socket_(std::move(socket)) {}
    void prepare(size_t bufferBytes);
    int sendSegments(const SocketAddress& to, std::span<std::byte> datagrams, size_t segmentBytes) const;
    int sendSeveral(const SocketAddress& to, std::span<std::byte> datagrams, size_t segmentBytes) const;
    int sendSingle(const SocketAddress& to, std::span<std::byte> datagrams, size_t segmentBytes) const;

    void lookForJoined(size_t messages, size_t datagrams, bool wantsLanding);

    struct Slots;
    struct FreeSlots {
        void operator()(Slots* slots) const;
    };
    FileDescriptor socket_;
    Sending sending_ = Sending::Segments;
    size_t bufferBytes_ = 0;
    bool tellsSenders_ = true;
    bool mayBeMore_ = false;
    Joined joined_ = Joined::Unknown;
    size_t single_ = 0; // datagrams that came among several, and not joined
    std::vector<Datagram> fetched_;
    std::unique_ptr<Slots, FreeSlots> slots_;
};

} // namespace mural::rsp
