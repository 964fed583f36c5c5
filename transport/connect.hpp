// Connections and listeners from their descriptions (connection_description.hpp).
#pragma once

#include <memory>
#include <string_view>

#include "transport/connection.hpp"

namespace mural {

// Connects to where the text leads: tcp://…, shm:N, or a group's host: rsp://…?control=HOST:PORT, or
// by a plug-in: fabric://….
Result<std::unique_ptr<Connection>> connectTo(std::string_view text, Deadline deadline);
// Listens where the text says: tcp://host:port, as a group's host: rsp://…, or by a plug-in. A group's connections are its members: each
// reads that member's stream; what is written to any of them goes to all.
Result<std::unique_ptr<Listener>> listenAt(std::string_view text);

} // namespace mural
