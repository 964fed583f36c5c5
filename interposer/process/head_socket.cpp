#include "interposer/process/head_socket.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/base/clock.hpp"
#include "interposer/process/launch_settings.hpp"
#include "interposer/diagnostics/log.hpp"

namespace mural {

namespace {

constexpr timeval kTimeout{30, 0};

// Returns -1 after an error, with errno set.
int connectTo(const sockaddr_un& address, size_t bytes) {
    const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0) return -1;
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &kTimeout, sizeof kTimeout);
    setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &kTimeout, sizeof kTimeout);
    const int64_t endNs = monotonicNowNs() + kTimeout.tv_sec * kNsPerS;
    int result = 0;
    do { // a signal interrupts it only while the head's backlog is full; no connection has begun
        result = ::connect(fd, reinterpret_cast<const sockaddr*>(&address), static_cast<socklen_t>(bytes));
    } while (result != 0 && errno == EINTR && monotonicNowNs() < endNs);
    if (result == 0) return fd;
    const int why = errno;
    close(fd);
    errno = why;
    return -1;
}

// Abstract names begin with a 0 byte and have no terminator. Paths end with a 0 byte.
int connectByName(const char* name, bool isAbstract) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const size_t length = std::strlen(name), begin = isAbstract ? 1 : 0;
    if (length + 1 > sizeof address.sun_path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    std::memcpy(address.sun_path + begin, name, length);
    return connectTo(address, offsetof(sockaddr_un, sun_path) + length + 1);
}

// Connects to the socket in the mount namespace of `mural run`, because a mount may hide its folder here. Session names
// are mural-PID-RANDOM.
int connectByRoot(const char* session, const char* path) {
    char seen[sizeof(sockaddr_un::sun_path)];
    const long pid = std::strncmp(session, "mural-", 6) ? 0 : std::strtol(session + 6, nullptr, 10);
    const int length = snprintf(seen, sizeof seen, "/proc/%ld/root%s", pid, path);
    if (pid <= 0 || length >= static_cast<int>(sizeof seen)) {
        errno = ENOENT;
        return -1;
    }
    return connectByName(seen, false);
}

} // namespace

int openHeadSocket() {
    const LaunchSettings& launch = launchSettings();
    if (!launch.session) return -1;
    int fd = connectByName(launch.session, true);
    if (fd < 0 && launch.socketPath) fd = connectByName(launch.socketPath, false);
    if (fd < 0 && launch.socketPath) fd = connectByRoot(launch.session, launch.socketPath);
    if (fd < 0)
        say("no head at session %s (%s): this program is not captured. A sandbox must give it access to %s",
            launch.session, std::strerror(errno), launch.socketPath ? launch.socketPath : "the network of mural run");
    return fd;
}

} // namespace mural
