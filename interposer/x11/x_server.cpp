#include "interposer/x11/x_server.hpp"

#include <arpa/inet.h>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>

namespace mural {

namespace {

constexpr int kFirstPort = 6000; // of display 0
constexpr char kSocketFolder[] = "/tmp/.X11-unix/X";

union Address {
    sockaddr any;
    sockaddr_un local;
    sockaddr_in v4;
    sockaddr_in6 v6;
};

bool peerOf(int socket, Address& address) {
    std::memset(&address, 0, sizeof address);
    socklen_t bytes = sizeof address - 1; // a path has a terminating 0
    return socket >= 0 && getpeername(socket, &address.any, &bytes) == 0;
}

// Skips the 0 byte of an abstract socket. Servers listen there and at a file of the same name.
const char* pathOf(const Address& address) { return address.local.sun_path + (address.local.sun_path[0] == 0); }

uint64_t hash(const void* data, size_t bytes) {
    uint64_t h = 0xcbf29ce484222325;
    for (size_t i = 0; i < bytes; ++i) h = (h ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3;
    return h | 1;
}

} // namespace

uint64_t serverOf(int socket) {
    Address a;
    if (!peerOf(socket, a)) return 0;
    if (a.any.sa_family == AF_UNIX) return hash(pathOf(a), std::strlen(pathOf(a)));
    if (a.any.sa_family == AF_INET) return hash(&a.v4, offsetof(sockaddr_in, sin_zero));
    return a.any.sa_family == AF_INET6 ? hash(&a.v6, sizeof a.v6) : 0;
}

bool displayNameOf(int socket, char* name, size_t bytes) {
    Address a;
    if (!peerOf(socket, a)) return false;
    if (a.any.sa_family == AF_UNIX) {
        const char* path = pathOf(a);
        const size_t folder = sizeof kSocketFolder - 1;
        const bool usual = std::strncmp(path, kSocketFolder, folder) == 0;
        std::snprintf(name, bytes, "%s%s", usual ? ":" : "", usual ? path + folder : path);
        return *path != 0;
    }
    char host[INET6_ADDRSTRLEN];
    const bool v4 = a.any.sa_family == AF_INET;
    const int port = ntohs(v4 ? a.v4.sin_port : a.v6.sin6_port);
    if ((!v4 && a.any.sa_family != AF_INET6) || port < kFirstPort) return false;
    if (!inet_ntop(a.any.sa_family, v4 ? static_cast<const void*>(&a.v4.sin_addr) : &a.v6.sin6_addr, host, sizeof host))
        return false;
    std::snprintf(name, bytes, v4 ? "%s:%d" : "[%s]:%d", host, port - kFirstPort);
    return true;
}

} // namespace mural
