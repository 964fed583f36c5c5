#include "transport/rsp/network_interface.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <ifaddrs.h>
#include <memory>
#include <net/if.h>
#include <netinet/in.h>

#include "transport/system_error.hpp"

namespace mural::rsp {

namespace {

double numberIn(const std::string& path) {
    double value = 0;
    std::ifstream(path) >> value;
    return value;
}

NetworkInterface describe(const ifaddrs& each) {
    NetworkInterface i;
    i.name = each.ifa_name;
    i.index = if_nametoindex(each.ifa_name);
    const std::string folder = "/sys/class/net/" + i.name;
    if (const double mtu = numberIn(folder + "/mtu"); mtu >= 68) i.mtuBytes = static_cast<size_t>(mtu);
    // In Mbit/s; -1 where a link has none, as those of virtual machines.
    if (const double speed = numberIn(folder + "/speed"); speed > 0) i.bytesPerS = speed * 1e6 / 8;
    i.multicast = (each.ifa_flags & IFF_MULTICAST) != 0;
    i.loopback = (each.ifa_flags & IFF_LOOPBACK) != 0;
    return i;
}

} // namespace

const SocketAddress* NetworkInterface::address(int family) const {
    const auto found = std::ranges::find(addresses, family, [](const SocketAddress& a) { return a.family(); });
    return found == addresses.end() ? nullptr : &*found;
}

Result<std::vector<NetworkInterface>> networkInterfaces() {
    ifaddrs* first = nullptr;
    if (getifaddrs(&first) != 0) return Error{"can't list the network interfaces: " + errnoText(errno)};
    const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(first, freeifaddrs);
    std::vector<NetworkInterface> all;
    for (const ifaddrs* each = first; each; each = each->ifa_next) {
        if (!each->ifa_addr || !(each->ifa_flags & IFF_UP)) continue;
        const int family = each->ifa_addr->sa_family;
        if (family != AF_INET && family != AF_INET6) continue;
        auto found = std::ranges::find(all, each->ifa_name, [](const NetworkInterface& i) { return i.name; });
        if (found == all.end()) found = all.insert(all.end(), describe(*each));
        SocketAddress a;
        a.sizeBytes = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
        std::memcpy(&a.storage, each->ifa_addr, a.sizeBytes);
        found->addresses.push_back(a);
    }
    return all;
}

Result<NetworkInterface> findInterface(std::string_view nameOrAddress, int family) {
    auto all = networkInterfaces();
    if (!all) return all.error();
    const NetworkInterface* loopback = nullptr;
    std::string known;
    for (const NetworkInterface& i : *all) {
        known += (known.empty() ? "" : ", ") + i.name;
        const auto isIt = [&](const SocketAddress& a) { return numericText(a) == nameOrAddress; };
        if (i.name == nameOrAddress || std::ranges::any_of(i.addresses, isIt)) {
            if (i.address(family)) return i;
            return Error{"network interface " + i.name + " has no " + (family == AF_INET ? "IPv4" : "IPv6") +
                         " address; give it one, or use a group of the other kind"};
        }
        if (!i.address(family)) continue;
        if (i.loopback) loopback = &i;
        else if (nameOrAddress.empty() && i.multicast) return i;
    }
    if (nameOrAddress.empty() && loopback) return *loopback;
    if (nameOrAddress.empty()) return Error{"no network interface is up that could do multicast; there are: " + known};
    return Error{"there is no network interface \"" + std::string(nameOrAddress) + "\" that is up; there are: " + known};
}

} // namespace mural::rsp
