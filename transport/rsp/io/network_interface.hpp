// The network interface for multicast.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural::rsp {

struct NetworkInterface {
    std::string name;
    unsigned index = 0;
    size_t mtuBytes = 1500;
    double bytesPerS = 0; // of the link; 0: unknown
    bool multicast = false;
    bool loopback = false;
    std::vector<SocketAddress> addresses;

    // Returns its first address of a family; null if it has none.
    [[nodiscard]] const SocketAddress* address(int family) const;
};

// Returns all interfaces that are up.
Result<std::vector<NetworkInterface>> networkInterfaces();

// Finds an interface by name or address. Empty: the first that is up, supports multicast and has an address of the
// family; the loopback only if there is no other.
Result<NetworkInterface> findInterface(std::string_view nameOrAddress, int family);

} // namespace mural::rsp
