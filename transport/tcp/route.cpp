#include "transport/tcp/route.hpp"

#include <sys/socket.h>

#include "common/ipc/file_descriptor.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural {

std::optional<SocketAddress> ownAddressTowards(const std::string& host, Deadline deadline) {
    constexpr uint16_t kDiscardPort = 9;
    auto addresses = resolveTcp(host, kDiscardPort, TcpRole::Connect, deadline);
    if (!addresses) return {};
    for (const SocketAddress& to : *addresses) {
        // Connecting a datagram socket sends nothing but selects the route.
        const FileDescriptor fd(socket(to.family(), SOCK_DGRAM | SOCK_CLOEXEC, 0));
        if (connect(fd.get(), to.get(), to.sizeBytes) == 0) return localTcpAddress(fd.get());
    }
    return {};
}

} // namespace mural
