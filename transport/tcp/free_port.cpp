#include "transport/tcp/free_port.hpp"

#include "transport/connection_description.hpp"

namespace mural {

Result<FreePort> listenOnFreePort(bool loopbackOnly) {
    auto listener = listenTcp(loopbackOnly ? "127.0.0.1" : "", 0);
    if (!listener) return listener.error();
    auto where = parseConnectionDescription((*listener)->describe());
    if (!where) return where.error();
    return FreePort{std::move(*listener), where->port};
}

} // namespace mural
