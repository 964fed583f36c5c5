// Unix sockets in the file system that belong to one user: listeners with mode 600, and checks of the peer's user.
#pragma once

#include <cerrno>
#include <cstring>
#include <string>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {

// Opens a non-blocking listener. type: SOCK_STREAM or SOCK_SEQPACKET. The error is the reason only, such as
// "bind: Permission denied".
inline Result<FileDescriptor> listenForUser(const std::string& path, int type, int backlog) {
    const auto failed = [](const char* call) { return Error{std::string(call) + ": " + std::strerror(errno)}; };
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof address.sun_path) return Error{"its path is too long"};
    std::memcpy(address.sun_path, path.data(), path.size());
    FileDescriptor fd(socket(AF_UNIX, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!fd.valid()) return failed("socket");
    // Linux gives the file the mode of the unbound socket, so no other user can connect in between.
    if (fchmod(fd.get(), S_IRUSR | S_IWUSR) != 0) return failed("fchmod");
    if (bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return failed("bind");
    if (listen(fd.get(), backlog) != 0) return failed("listen");
    return fd;
}

// True if the process at the other end has the user of this process. Clients check it, because any user may listen
// under a name that looks right.
inline bool isPeerOwn(int socket) {
    ucred peer{};
    socklen_t size = sizeof peer;
    return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == geteuid();
}

// The same for listeners, which serve root as well.
inline bool isPeerOwnOrRoot(int socket) {
    ucred peer{};
    socklen_t size = sizeof peer;
    return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && (peer.uid == geteuid() || peer.uid == 0);
}

} // namespace mural
