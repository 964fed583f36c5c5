// Batches datagrams of one size to one destination, seals them, and sends them with one system call.
#pragma once

#include <map>
#include <vector>

#include "transport/rsp/wire/datagram_cipher.hpp"
#include "transport/rsp/io/udp_socket.hpp"

namespace mural::rsp {

class SendBatcher {
public:
    explicit SendBatcher(UdpSocket& socket) : socket_(socket), bytes_(kRoomBytes) {}

    void useKeys(const SessionKeys& keys, MemberId self);
    void setGroup(const SocketAddress& group) { group_ = group; }
    void setMember(MemberId id, const SocketAddress& address) { members_[id] = address; }
    void removeMember(MemberId id) { members_.erase(id); }

    // Returns room for one datagram, as DatagramSink::datagram. Discards datagrams before keys exist, and to members
    // without an address.
    std::span<std::byte> datagram(MemberId to, size_t bytes);
    // Sends the current batch.
    void flush();

    [[nodiscard]] uint64_t datagrams() const { return datagrams_; }
    [[nodiscard]] uint64_t sendings() const { return sendings_; }
    // Last network error; empty: none. The datagrams of a failed system call count as lost.
    [[nodiscard]] const std::string& error() const { return error_; }

private:
    static constexpr size_t kRoomBytes = 65'536; // for one batch, or for one datagram, which may be longer

    void seal();
    [[nodiscard]] const SocketAddress* addressOf(MemberId id) const;

    UdpSocket& socket_;
    std::unique_ptr<DatagramSealer> sealer_;
    size_t tagBytes_ = 0;
    SocketAddress group_;
    std::map<MemberId, SocketAddress> members_;
    std::vector<std::byte> bytes_;
    MemberId to_ = 0;
    size_t used_ = 0;      // bytes of sealed datagrams
    size_t openBytes_ = 0; // bytes of the datagram in progress, after them
    size_t segmentBytes_ = 0;
    size_t count_ = 0;
    uint64_t datagrams_ = 0;
    uint64_t sendings_ = 0;
    std::string error_;
};

} // namespace mural::rsp
