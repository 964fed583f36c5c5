#include "transport/rsp/io/network_interface.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ifaddrs.h>
#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <memory>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>

#include "common/ipc/file_descriptor.hpp"
#include "transport/system_error.hpp"

namespace mural::rsp {

namespace {

// Queries the kernel about an interface of this process's network namespace; /sys may show another one's (unshare,
// containers).
class InterfaceQuestion {
public:
    explicit InterfaceQuestion(const std::string& name) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        name.copy(request_.ifr_name, sizeof request_.ifr_name - 1);
    }
    // 0: unknown.
    size_t mtuBytes() {
        return request(SIOCGIFMTU) && request_.ifr_mtu > 0 ? static_cast<size_t>(request_.ifr_mtu) : 0;
    }
    double bytesPerS() {
        ethtool_cmd link{};
        link.cmd = ETHTOOL_GSET;
        request_.ifr_data = reinterpret_cast<char*>(&link);
        if (!request(SIOCETHTOOL)) return 0;
        const uint32_t mbit = ethtool_cmd_speed(&link);
        return mbit == 0 || mbit == static_cast<uint32_t>(SPEED_UNKNOWN) || mbit == UINT16_MAX ? 0 : mbit * 1e6 / 8;
    }

private:
    bool request(unsigned long what) { return ioctl(socket_.get(), what, &request_) == 0; }
    FileDescriptor socket_;
    ifreq request_{};
};

NetworkInterface describe(const ifaddrs& each) {
    NetworkInterface i;
    i.name = each.ifa_name;
    i.index = if_nametoindex(each.ifa_name);
    InterfaceQuestion question(i.name);
    if (const size_t mtu = question.mtuBytes(); mtu >= 68) i.mtuBytes = mtu;
    i.bytesPerS = question.bytesPerS();
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
    if (getifaddrs(&first) != 0) return Error{"cannot list the network interfaces: " + errnoText(errno)};
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
                         " address; add one, or use a group of the other address family"};
        }
        if (!i.address(family)) continue;
        if (i.loopback)
            loopback = &i;
        else if (nameOrAddress.empty() && i.multicast)
            return i;
    }
    if (nameOrAddress.empty() && loopback) return *loopback;
    if (nameOrAddress.empty()) return Error{"no active network interface with multicast; available: " + known};
    return Error{"no active network interface \"" + std::string(nameOrAddress) + "\"; available: " + known};
}

} // namespace mural::rsp
