// Finds the addresses by which other machines reach this one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {

// Returns the own address on the route to `host` (name or number); empty without a route, or for an unknown name.
std::optional<SocketAddress> ownAddressTowards(const std::string& host, Deadline deadline);

// Returns the addresses of this machine's interfaces that are up, without loopback and link-local ones.
std::vector<std::string> ownAddresses();

} // namespace mural
