// An address of a socket, IPv4 or IPv6.
#pragma once

#include <sys/socket.h>

namespace mural {

struct SocketAddress {
    sockaddr_storage storage{};
    socklen_t sizeBytes = 0;

    [[nodiscard]] const sockaddr* get() const {
        return reinterpret_cast<const sockaddr*>(&storage);
    }
    [[nodiscard]] sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
    [[nodiscard]] int family() const { return storage.ss_family; }
};

} // namespace mural
