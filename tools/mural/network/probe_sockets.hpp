// Probe sockets of one machine: unicast, multicast group, and link-local group.
#pragma once

#include <array>
#include <map>
#include <string>

#include "common/base/clock.hpp"
#include "tools/mural/network/probe_datagram.hpp"
#include "transport/rsp/io/udp_socket.hpp"

namespace mural::cli {

constexpr size_t kWantedBufferBytes = size_t{8} << 20; // as rsp::GroupOptions

class ProbeSockets {
public:
    static Result<ProbeSockets> open(const SocketAddress& group, const rsp::NetworkInterface& interface,
                                     uint64_t survey, bool doctor);

    [[nodiscard]] uint16_t port() const; // of the unicast socket
    // Returns the granted part of kWantedBufferBytes; the kernel doubles the value for its overhead.
    [[nodiscard]] size_t bufferBytes() const { return own_.bufferBytes() / 2; }
    // Returns the reason why a kind of probe is unusable here (join or send failed); empty: usable.
    [[nodiscard]] const std::string& trouble(ProbePath path) const { return troubles_[static_cast<size_t>(path)]; }

    // Sends one probe; `single` is the destination of ProbeWay::Single.
    void send(ProbePath path, size_t sizeBytes, const SocketAddress& single);
    // Receives until the deadline, or until `alsoFd` is readable (-1: none); returns true for the latter.
    bool listen(Deadline deadline, int alsoFd = -1);

    struct Seen {
        ProbePath path;
        uint16_t sizeBytes;
        bool operator<(const Seen& o) const { return path != o.path ? path < o.path : sizeBytes < o.sizeBytes; }
    };
    // Returns the arrivals since the last call.
    [[nodiscard]] std::map<Seen, unsigned> take() { return std::exchange(seen_, {}); }

private:
    ProbeSockets(rsp::UdpSocket own, uint64_t survey, bool doctor)
        : own_(std::move(own)), survey_(survey), doctor_(doctor) {}
    void receive(rsp::UdpSocket& socket, bool multicast);

    rsp::UdpSocket own_;
    std::optional<rsp::UdpSocket> inGroup_, inLinkLocal_;
    SocketAddress group_, linkLocal_;
    uint64_t survey_;
    bool doctor_;
    std::array<std::string, std::size(kProbePaths)> troubles_;
    std::map<Seen, unsigned> seen_;
};

} // namespace mural::cli
