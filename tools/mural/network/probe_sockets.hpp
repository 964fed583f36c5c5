// The sockets that one machine probes the network by: one of its own, one in the group, one in a link-local group.
#pragma once

#include <array>
#include <map>
#include <string>

#include "common/clock.hpp"
#include "tools/mural/network/probe_datagram.hpp"
#include "transport/rsp/udp_socket.hpp"

namespace mural::cli {

constexpr size_t kWantedBufferBytes = size_t{8} << 20; // as rsp::GroupOptions

class ProbeSockets {
public:
    static Result<ProbeSockets> open(const SocketAddress& group, const rsp::NetworkInterface& interface, uint64_t survey, bool doctor);

    [[nodiscard]] uint16_t port() const; // of the own socket
    // What the kernel gave for kWantedBufferBytes; it counts its own bookkeeping, and so doubles.
    [[nodiscard]] size_t bufferBytes() const { return own_.bufferBytes() / 2; }
    // Why a way can't be used here: the group was not joined, or sending failed; empty: it can.
    [[nodiscard]] const std::string& trouble(ProbeWay way) const { return troubles_[static_cast<size_t>(way)]; }

    // One probe; `single` is where ProbeWay::Single leads.
    void send(ProbeWay way, size_t sizeBytes, const SocketAddress& single);
    // Takes what comes until the deadline, or until `alsoFd` is readable (-1: none). True: it is.
    bool listen(Deadline deadline, int alsoFd = -1);

    struct Seen {
        ProbeWay way;
        uint16_t sizeBytes;
        bool operator<(const Seen& o) const { return way != o.way ? way < o.way : sizeBytes < o.sizeBytes; }
    };
    // How many of each have come since the last call.
    [[nodiscard]] std::map<Seen, unsigned> take() { return std::exchange(seen_, {}); }

private:
    ProbeSockets(rsp::UdpSocket own, uint64_t survey, bool doctor) : own_(std::move(own)), survey_(survey), doctor_(doctor) {}
    void hear(rsp::UdpSocket& socket, bool multicast);

    rsp::UdpSocket own_;
    std::optional<rsp::UdpSocket> inGroup_, inLinkLocal_;
    SocketAddress group_, linkLocal_;
    uint64_t survey_;
    bool doctor_;
    std::array<std::string, std::size(kProbeWays)> troubles_;
    std::map<Seen, unsigned> seen_;
};

} // namespace mural::cli
