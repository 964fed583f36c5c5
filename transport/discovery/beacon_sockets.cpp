#include "transport/discovery/beacon_sockets.hpp"

#include <algorithm>
#include <poll.h>

namespace mural {

namespace {

constexpr const char* kGroups[] = {"239.255.77.86", "ff12::4d55:5241"}; // organisation-local and link-local scope
constexpr uint16_t kPort = 4276;
constexpr size_t kBufferBytes = 256 * 1024;

} // namespace

void BeaconSockets::openOn(const rsp::NetworkInterface& interface) {
    for (const char* text : kGroups) {
        auto group = numericAddress(text, kPort);
        if (!group || !interface.address(group->family())) continue;
        auto own = rsp::UdpSocket::openOwn(interface, group->family(), kBufferBytes);
        auto listening = rsp::UdpSocket::openGroup(*group, interface, kBufferBytes);
        if (own && listening)
            links_.push_back({std::move(*own), std::move(*listening), *group});
        else
            trouble_ = own ? listening.error().message : own.error().message;
    }
}

Result<BeaconSockets> BeaconSockets::open(const std::string& wanted) {
    auto all = rsp::networkInterfaces();
    if (!all) return all.error();
    BeaconSockets sockets;
    std::string known;
    const auto isWanted = [&](const rsp::NetworkInterface& i) {
        return i.name == wanted ||
               std::ranges::any_of(i.addresses, [&](const SocketAddress& a) { return numericText(a) == wanted; });
    };
    for (const rsp::NetworkInterface& i : *all) {
        known += (known.empty() ? "" : ", ") + i.name;
        if (wanted.empty() ? i.multicast && !i.loopback : isWanted(i)) sockets.openOn(i);
    }
    // Without a network the loopback remains.
    if (sockets.links_.empty() && wanted.empty()) {
        for (const rsp::NetworkInterface& i : *all)
            if (i.loopback) sockets.openOn(i);
    }
    if (!sockets.links_.empty()) return sockets;
    if (!sockets.trouble_.empty()) return Error{sockets.trouble_};
    if (!wanted.empty()) return Error{"no active network interface \"" + wanted + "\"; available: " + known};
    return Error{"no active network interface with multicast; available: " + known};
}

void BeaconSockets::broadcast(std::span<const std::byte> bytes) {
    std::vector<std::byte> datagram(bytes.begin(), bytes.end());
    for (Link& link : links_) (void)link.own.send(link.to, datagram, datagram.size());
}

bool BeaconSockets::listen(Deadline deadline, int alsoFd, const Handler& handler) {
    std::vector<pollfd> polled{{alsoFd, POLLIN, 0}};
    for (const Link& link : links_) polled.push_back({link.group.descriptor(), POLLIN, 0});
    const int64_t leftNs = deadline.leftNs(kNsPerS);
    (void)poll(polled.data(), polled.size(), static_cast<int>((leftNs + kNsPerMs - 1) / kNsPerMs));
    for (Link& link : links_) {
        for (const rsp::UdpSocket::Datagram& d : link.group.fetch()) // the next round reads the rest
            if (const auto a = decodeAnnouncement(d.bytes)) handler(*a, numericText(*d.from));
    }
    return polled.front().revents != 0;
}

std::string BeaconSockets::fingerprint() {
    std::string text;
    auto all = rsp::networkInterfaces();
    if (!all) return text;
    for (const rsp::NetworkInterface& i : *all) {
        text += i.name + (i.multicast ? "+" : "-");
        for (const SocketAddress& a : i.addresses) text += numericText(a) + ",";
    }
    return text;
}

} // namespace mural
