// Names and addresses of TCP endpoints, IPv4 and IPv6.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {

using TcpAddress = SocketAddress;

enum class TcpRole { Connect, Listen };

// Returns all addresses of a host in connection order. Lookups run on a separate thread, because the resolver has no
// deadline.
Result<std::vector<TcpAddress>> resolveTcp(const std::string& host, uint16_t port, TcpRole role, Deadline deadline);

// Returns "tcp://host:port", with IPv6 addresses in brackets.
std::string tcpText(const std::string& host, uint16_t port);
std::string tcpText(const TcpAddress& address);

uint16_t tcpPort(const TcpAddress& address);
TcpAddress localTcpAddress(int socket);
TcpAddress peerTcpAddress(int socket);
bool sameTcpAddress(const TcpAddress& a, const TcpAddress& b);

} // namespace mural
