// Shared memory between two processes. One inherited descriptor suffices: a Unix socket that transfers the memory's
// descriptor and then reports liveness.
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/socket.h>

#include "common/ipc/descriptor_message.hpp"
#include "common/log/log.hpp"
#include "transport/shm/ring_connection.hpp"
#include "transport/system_error.hpp"

namespace mural {

namespace {

constexpr char kGreeting = 'M'; // SCM_RIGHTS requires at least one byte of data

Result<void> sendDescriptor(int socket, int fd) {
    if (sendWithDescriptor(socket, std::as_bytes(std::span(&kGreeting, 1)), fd) != 1)
        return Error{"shm: cannot pass the memory's descriptor: " + errnoText(errno)};
    return {};
}

// Never blocks: the offer is in the socket before the other process starts.
Result<FileDescriptor> receiveDescriptor(int socket) {
    char greeting = 0;
    FileDescriptor memfd;
    const ssize_t got = receiveWithDescriptor(socket, std::as_writable_bytes(std::span(&greeting, 1)), memfd);
    const std::string where = "shm: descriptor " + std::to_string(socket);
    if (got < 0) return Error{where + ": " + errnoText(errno) + "; pass the descriptor from offerSharedMemory"};
    if (got != 1 || greeting != kGreeting || !memfd.valid()) {
        return Error{where + " carries no shared memory: it was opened before, or the peer has ended"};
    }
    return memfd;
}

} // namespace

Result<SharedMemoryOffer> offerSharedMemory(size_t capacityBytes) {
    FileDescriptor memfd;
    auto memory = RingMemory::makeShared(capacityBytes, memfd);
    if (!memory) return memory.error();
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        return Error{"shm: socketpair: " + errnoText(errno) + "; raise the limit of open files (ulimit -n)"};
    }
    FileDescriptor ownEnd(ends[0]);
    FileDescriptor peerEnd(ends[1]);
    const auto sent = sendDescriptor(ownEnd.get(), memfd.get());
    if (!sent) return sent.error();
    if (fcntl(peerEnd.get(), F_SETFD, 0) != 0) { // inherited on purpose
        return Error{"shm: cannot make a descriptor inheritable: " + errnoText(errno)};
    }
    SharedMemoryOffer offer;
    offer.connection = std::make_unique<RingConnection>(*memory, 0, std::move(ownEnd), "shm:");
    offer.peerFd = peerEnd.release();
    log::debug(log::Topic::Transport, "shared memory of ", capacityBytes, " bytes per direction, peer descriptor ",
               offer.peerFd);
    return offer;
}

// Takes ownership of fd, even on failure. The child's own children must not inherit it: they would make a dead process
// look alive.
Result<std::unique_ptr<Connection>> openSharedMemory(int fd) {
    FileDescriptor socket(fd);
    if (fcntl(fd, F_SETFD, FD_CLOEXEC) != 0) {
        return Error{"shm: descriptor " + std::to_string(fd) + ": " + errnoText(errno) +
                     "; it must be inherited from the process that offered it"};
    }
    auto memfd = receiveDescriptor(fd);
    if (!memfd) return memfd.error();
    auto memory = RingMemory::openShared(memfd->get());
    if (!memory) return memory.error();
    log::debug(log::Topic::Transport, "shared memory opened from descriptor ", fd);
    return std::unique_ptr<Connection>(std::make_unique<RingConnection>(*memory, 1, std::move(socket), "shm:"));
}

} // namespace mural
