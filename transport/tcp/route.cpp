#include "transport/tcp/route.hpp"

#include <cstring>
#include <ifaddrs.h>
#include <memory>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "common/ipc/file_descriptor.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural {

std::optional<SocketAddress> ownAddressTowards(const std::string& host, Deadline deadline) {
    constexpr uint16_t kDiscardPort = 9;
    auto addresses = resolveTcp(host, kDiscardPort, TcpRole::Connect, deadline);
    if (!addresses) return {};
    for (const SocketAddress& to : *addresses) {
        // Connecting a datagram socket sends nothing but selects the route.
        const FileDescriptor fd(socket(to.family(), SOCK_DGRAM | SOCK_CLOEXEC, 0));
        if (connect(fd.get(), to.get(), to.sizeBytes) == 0) return localTcpAddress(fd.get());
    }
    return {};
}

std::vector<std::string> ownAddresses() {
    ifaddrs* first = nullptr;
    if (getifaddrs(&first) != 0) return {};
    const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> all(first, freeifaddrs);
    std::vector<std::string> addresses;
    for (const ifaddrs* i = first; i != nullptr; i = i->ifa_next) {
        if (i->ifa_addr == nullptr || (i->ifa_flags & IFF_UP) == 0 || (i->ifa_flags & IFF_LOOPBACK) != 0) continue;
        SocketAddress address;
        const int family = i->ifa_addr->sa_family;
        if (family != AF_INET && family != AF_INET6) continue;
        address.sizeBytes = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
        std::memcpy(&address.storage, i->ifa_addr, address.sizeBytes);
        const auto* const six = reinterpret_cast<const sockaddr_in6*>(&address.storage);
        if (family == AF_INET6 && IN6_IS_ADDR_LINKLOCAL(&six->sin6_addr)) continue; // needs a scope
        addresses.push_back(numericText(address));
    }
    return addresses;
}

} // namespace mural
