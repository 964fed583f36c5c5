// The network card that multicast goes through.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/result.hpp"
#include "transport/socket_address.hpp"

namespace mural::rsp {

struct NetworkInterface {
    std::string name;
    unsigned index = 0;
    size_t mtuBytes = 1500;
    double bytesPerS = 0; // of the link; 0: it does not tell
    bool multicast = false;
    bool loopback = false;
    std::vector<SocketAddress> addresses;

    // Its first address of a family; nothing when it has none.
    [[nodiscard]] const SocketAddress* address(int family) const;
};

// All that are up.
Result<std::vector<NetworkInterface>> networkInterfaces();

// By name or by one of its addresses. Empty: the first that is up, does multicast and has an address of the family, not
// the loopback; that only when there is no other.
Result<NetworkInterface> findInterface(std::string_view nameOrAddress, int family);

} // namespace mural::rsp
