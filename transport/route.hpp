// By which of its addresses this machine is reached from another.
#pragma once

#include <optional>
#include <string>

#include "common/clock.hpp"
#include "transport/socket_address.hpp"

namespace mural {

// The own address on the way to `host` (a name, or numbers); nothing when there is no way or the name is not known.
std::optional<SocketAddress> ownAddressTowards(const std::string& host, Deadline deadline);

} // namespace mural
