// A socket address, IPv4 or IPv6.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <sys/socket.h>

#include "common/base/result.hpp"

namespace mural {

struct SocketAddress {
    sockaddr_storage storage{};
    socklen_t sizeBytes = 0;

    [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
    [[nodiscard]] sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
    [[nodiscard]] int family() const { return storage.ss_family; }
    [[nodiscard]] bool isMulticast() const;
};

// Parses a numeric address, not a name: "10.0.0.1", "ff12::4".
Result<SocketAddress> numericAddress(const std::string& host, uint16_t port);
// Formats an address without its port; IPv4-mapped IPv6 as IPv4.
std::string numericText(const SocketAddress& address);
// "10.0.0.1:80", "[ff12::4]:80".
Result<SocketAddress> numericEndpoint(std::string_view text);

struct HostPort {
    std::string host;
    uint16_t port = 0;
};
// Parses "host:port"; IPv6 addresses in brackets; the host may be empty.
Result<HostPort> splitHostPort(std::string_view text);
// Formats host and port.
std::string endpointText(const std::string& host, uint16_t port);

} // namespace mural
