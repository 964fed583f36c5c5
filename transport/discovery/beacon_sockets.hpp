// The sockets of the beacon: on each card that does multicast, for IPv4 and IPv6.
#pragma once

#include <functional>

#include "common/clock.hpp"
#include "transport/discovery/announcement.hpp"
#include "transport/rsp/udp_socket.hpp"

namespace mural {

class BeaconSockets {
public:
    // `interface`: name or address of the only one; empty: all. Errors: there is none.
    static Result<BeaconSockets> open(const std::string& interface);

    // On all of them. What a card does not take is lost.
    void say(std::span<const std::byte> bytes);
    using Handler = std::function<void(const Announcement&, const std::string& from)>;
    // Until something comes, the deadline, or `alsoFd` is readable (-1: none); true: it is.
    bool listen(Deadline deadline, int alsoFd, const Handler& handler);

    // Changes as cards and addresses come and go: then they are to be opened anew.
    static std::string fingerprint();

private:
    struct Link {
        rsp::UdpSocket own;
        rsp::UdpSocket group;
        SocketAddress to;
    };
    void openOn(const rsp::NetworkInterface& interface);
    std::vector<Link> links_;
    std::string trouble_; // the last card that could not be used
};

} // namespace mural
