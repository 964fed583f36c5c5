// A listener on any free port, for peers that learn the port in another way.
#pragma once

#include <memory>

#include "transport/connection.hpp"

namespace mural {

struct FreePort {
    std::unique_ptr<Listener> listener;
    uint16_t port = 0;
};

// loopbackOnly: for peers on this machine.
Result<FreePort> listenOnFreePort(bool loopbackOnly);

} // namespace mural
