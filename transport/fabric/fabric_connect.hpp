// Connections fabric://host:port?provider=NAME: connecting and listening.
#pragma once

#include <memory>

#include "transport/connection.hpp"
#include "transport/connection_description.hpp"

namespace mural::fabric {

// Waits until the other end has accepted.
Result<std::unique_ptr<Connection>> connectFabric(const ConnectionDescription& to, Deadline deadline);
Result<std::unique_ptr<Listener>> listenFabric(const ConnectionDescription& at);

} // namespace mural::fabric
