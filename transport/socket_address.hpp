// An address of a socket, IPv4 or IPv6.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <sys/socket.h>

#include "common/result.hpp"

namespace mural {

struct SocketAddress {
    sockaddr_storage storage{};
    socklen_t sizeBytes = 0;

    [[nodiscard]] const sockaddr* get() const {
        return reinterpret_cast<const sockaddr*>(&storage);
    }
    [[nodiscard]] sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
    [[nodiscard]] int family() const { return storage.ss_family; }
    [[nodiscard]] bool isMulticast() const;
};

// Of numbers, not names: "10.0.0.1", "ff12::4".
Result<SocketAddress> numericAddress(const std::string& host, uint16_t port);
// The other way round, without the port; IPv4 mapped into IPv6 as IPv4.
std::string numericText(const SocketAddress& address);
// "10.0.0.1:80", "[ff12::4]:80".
Result<SocketAddress> numericEndpoint(std::string_view text);

struct HostPort {
    std::string host;
    uint16_t port = 0;
};
// "host:port"; brackets around IPv6 numbers; the host may be empty.
Result<HostPort> splitHostPort(std::string_view text);
// The other way round.
std::string endpointText(const std::string& host, uint16_t port);

} // namespace mural
