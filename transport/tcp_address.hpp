// Names and numbers of TCP endpoints, IPv4 and IPv6.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "transport/socket_address.hpp"

namespace mural {

using TcpAddress = SocketAddress;

enum class TcpRole { Connect, Listen };

// All addresses of a host in the order to try them. Names are looked up on a thread of their own,
// because the resolver knows no deadline.
Result<std::vector<TcpAddress>>
resolveTcp(const std::string& host, uint16_t port, TcpRole role, Deadline deadline);

// "tcp://host:port"; brackets around IPv6 numbers.
std::string tcpText(const std::string& host, uint16_t port);
std::string tcpText(const TcpAddress& address);

uint16_t tcpPort(const TcpAddress& address);
TcpAddress localTcpAddress(int socket);
TcpAddress peerTcpAddress(int socket);
bool sameTcpAddress(const TcpAddress& a, const TcpAddress& b);

} // namespace mural
