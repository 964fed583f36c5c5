// UDP socket for RSP: many datagrams per system call, and the kernel's drop counter.
//
// Sending: up to 64 datagrams of equal size as one message (UDP_SEGMENT); with sendmmsg where kernel or card refuses
// that; otherwise one by one. A refused method is not tried again. Receiving: recvmmsg, with UDP_GRO where cards
// coalesce datagrams; otherwise each is received directly into the reader's buffers.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "transport/rsp/wire/datagram.hpp"
#include "transport/rsp/protocol/receive_buffers.hpp"
#include "transport/rsp/io/network_interface.hpp"
#include "transport/rsp/wire/datagram_sink.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural::rsp {

class UdpSocket {
public:
    // Opens a socket for datagrams to the group.
    static Result<UdpSocket> openGroup(const SocketAddress& group, const NetworkInterface& interface,
                                       size_t bufferBytes);
    // Opens a socket on any free port, for sending, and for datagrams to this member.
    static Result<UdpSocket> openOwn(const NetworkInterface& interface, int family, size_t bufferBytes);

    // Sets whether datagrams to the group reach members on this machine.
    void setLoop(bool loop);
    // Drops this member's own looped-back datagrams in the kernel, before they take room in the buffer. The filter runs
    // for each datagram. A sender on the same machine executes the filters of its receivers.
    void ignoreMember(MemberId self);
    void ignoreNobody();

    // Omits sender addresses, which cost the kernel time per datagram.
    void omitSenders() { reportsSenders_ = false; }

    [[nodiscard]] int descriptor() const { return socket_.get(); }
    [[nodiscard]] SocketAddress localAddress() const;

    // Sends datagrams of segmentBytes each (the last may be shorter), at most maxInSend(). Datagrams without room
    // in the network count as lost. Errors: the network is down; the datagrams are too long.
    Result<void> send(const SocketAddress& to, std::span<std::byte> datagrams, size_t segmentBytes);

    struct Datagram {
        std::span<std::byte> bytes; // in the reader's buffers, or in the socket's own
        const SocketAddress* from;
    };
    // Receives pending datagrams, in order, with one system call. They are valid until the next call. Once GRO is known
    // to be absent, all of them are in the reader's buffers, and longer datagrams are lost.
    std::span<const Datagram> fetch(const ReceiveBuffers& landing = {});
    // Returns true if the last call reached its limit.
    [[nodiscard]] bool mayBeMore() const { return mayBeMore_; }

    // Returns the number of datagrams dropped by the kernel, including those of ignoreMember().
    [[nodiscard]] uint32_t dropped() const;
    // Returns the granted receive buffer, including the kernel's overhead.
    [[nodiscard]] size_t bufferBytes() const { return bufferBytes_; }
    // Returns the number of datagrams of a size that fit into the receive buffer.
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

    void detectCoalescing(size_t messages, size_t datagrams, bool wantsLanding);

    struct Slots;
    struct FreeSlots {
        void operator()(Slots* slots) const;
    };
    FileDescriptor socket_;
    Sending sending_ = Sending::Segments;
    size_t bufferBytes_ = 0;
    bool reportsSenders_ = true;
    bool mayBeMore_ = false;
    Joined joined_ = Joined::Unknown;
    size_t single_ = 0; // received among several and not coalesced
    std::vector<Datagram> fetched_;
    std::unique_ptr<Slots, FreeSlots> slots_;
};

} // namespace mural::rsp
