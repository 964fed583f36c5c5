// Datagrams on their way to a socket: those of one size to one place are gathered, sealed, and go out together.
#pragma once

#include <map>
#include <vector>

#include "transport/rsp/datagram_seal.hpp"
#include "transport/rsp/udp_socket.hpp"

namespace mural::rsp {

class BatchOutbox {
public:
    explicit BatchOutbox(UdpSocket& socket) : socket_(socket), bytes_(kRoomBytes) {}

    void useKeys(const SessionKeys& keys, MemberId self);
    void setGroup(const SocketAddress& group) { group_ = group; }
    void setMember(MemberId id, const SocketAddress& address) { members_[id] = address; }
    void removeMember(MemberId id) { members_.erase(id); }

    // Room for one, as Outbox::datagram. Before there are keys, and for who has no address, it goes nowhere.
    std::span<std::byte> datagram(MemberId to, size_t bytes);
    // Sends what has been gathered.
    void flush();

    [[nodiscard]] uint64_t datagrams() const { return datagrams_; }
    [[nodiscard]] uint64_t sendings() const { return sendings_; }
    // The last error of the network, which is then as if all was lost; empty: none.
    [[nodiscard]] const std::string& error() const { return error_; }

private:
    static constexpr size_t kRoomBytes = 65'536; // of a sending, or of one datagram, which may be longer

    void seal();
    [[nodiscard]] const SocketAddress* addressOf(MemberId id) const;

    UdpSocket& socket_;
    std::unique_ptr<DatagramSealer> sealer_;
    size_t tagBytes_ = 0;
    SocketAddress group_;
    std::map<MemberId, SocketAddress> members_;
    std::vector<std::byte> bytes_;
    MemberId to_ = 0;
    size_t used_ = 0;    // bytes of sealed datagrams
    size_t openBytes_ = 0; // of the one that is being filled, behind them
    size_t segmentBytes_ = 0;
    size_t count_ = 0;
    uint64_t datagrams_ = 0;
    uint64_t sendings_ = 0;
    std::string error_;
};

} // namespace mural::rsp
