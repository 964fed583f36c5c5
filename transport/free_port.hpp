// A listener on whatever port is free, for peers that are told it another way.
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
