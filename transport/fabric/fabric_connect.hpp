// Connects and listens for fabric://host:port?provider=NAME.
#pragma once

#include <memory>

#include "transport/connection.hpp"
#include "transport/connection_description.hpp"

namespace mural::fabric {

// Blocks until the peer has accepted.
Result<std::unique_ptr<Connection>> connectFabric(const ConnectionDescription& to, Deadline deadline);
Result<std::unique_ptr<Listener>> listenFabric(const ConnectionDescription& at);

} // namespace mural::fabric
