// Creates connections and listeners from their descriptions (connection_description.hpp).
#pragma once

#include <memory>
#include <string_view>

#include "transport/connection.hpp"

namespace mural {

// Connects to tcp://..., shm:N, a group's host (rsp://...?control=HOST:PORT), or through a plug-in (fabric://...).
Result<std::unique_ptr<Connection>> connectTo(std::string_view text, Deadline deadline);
// Listens at tcp://host:port, hosts a group (rsp://...), or listens through a plug-in. The connections of a group are
// its members: each reads that member's stream, and a write to any of them reaches all.
Result<std::unique_ptr<Listener>> listenAt(std::string_view text);

} // namespace mural
