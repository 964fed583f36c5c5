// Sockets of the beacon: one per multicast interface, for IPv4 and IPv6.
#pragma once

#include <functional>

#include "common/base/clock.hpp"
#include "transport/discovery/announcement.hpp"
#include "transport/rsp/io/udp_socket.hpp"

namespace mural {

class BeaconSockets {
public:
    // `interface`: name or address of a single interface; empty: all. Error: none exists.
    static Result<BeaconSockets> open(const std::string& interface);

    // Sends on all interfaces, best effort.
    void broadcast(std::span<const std::byte> bytes);
    using Handler = std::function<void(const Announcement&, const std::string& from)>;
    // Waits for datagrams, the deadline, or readability of `alsoFd` (-1: none); returns true for the latter.
    bool listen(Deadline deadline, int alsoFd, const Handler& handler);

    // Value that changes with interfaces and addresses; the sockets must then be reopened.
    static std::string fingerprint();

private:
    struct Link {
        rsp::UdpSocket own;
        rsp::UdpSocket group;
        SocketAddress to;
    };
    void openOn(const rsp::NetworkInterface& interface);
    std::vector<Link> links_;
    std::string trouble_; // error of the last unusable interface
};

} // namespace mural
