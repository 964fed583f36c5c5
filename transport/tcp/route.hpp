// Finds the address by which another machine reaches this one.
#pragma once

#include <optional>
#include <string>

#include "common/base/clock.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {

// Returns the own address on the route to `host` (name or number); empty without a route, or for an unknown name.
std::optional<SocketAddress> ownAddressTowards(const std::string& host, Deadline deadline);

} // namespace mural
