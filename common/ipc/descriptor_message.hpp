// Messages over Unix sockets that carry at most one descriptor (SCM_RIGHTS). No call blocks.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <span>
#include <sys/socket.h>

#include "common/ipc/file_descriptor.hpp"

namespace mural {

// Sends at least one byte. fd: travels with the first byte; negative: none. Returns the number of bytes, or -1 with
// errno.
inline ssize_t sendWithDescriptor(int socket, std::span<const std::byte> bytes, int fd) {
    iovec part{const_cast<std::byte*>(bytes.data()), bytes.size()};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof fd)] = {};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    if (fd >= 0) {
        message.msg_control = control;
        message.msg_controllen = sizeof control;
        cmsghdr* header = CMSG_FIRSTHDR(&message);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof fd);
        std::memcpy(CMSG_DATA(header), &fd, sizeof fd);
    }
    ssize_t sent = 0;
    do {
        sent = sendmsg(socket, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
    } while (sent < 0 && errno == EINTR);
    return sent;
}

// Returns the number of bytes, 0 at the end, or -1 with errno. fd: the descriptor, close-on-exec; invalid without one.
inline ssize_t receiveWithDescriptor(int socket, std::span<std::byte> bytes, FileDescriptor& fd) {
    iovec part{bytes.data(), bytes.size()};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    ssize_t got = 0;
    do {
        got = recvmsg(socket, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    } while (got < 0 && errno == EINTR);
    fd = FileDescriptor();
    if (got < 0) return got;
    for (cmsghdr* at = CMSG_FIRSTHDR(&message); at != nullptr; at = CMSG_NXTHDR(&message, at)) {
        if (at->cmsg_level != SOL_SOCKET || at->cmsg_type != SCM_RIGHTS || at->cmsg_len < CMSG_LEN(sizeof(int)))
            continue;
        int number = -1;
        std::memcpy(&number, CMSG_DATA(at), sizeof number);
        fd = FileDescriptor(number);
    }
    return got;
}

} // namespace mural
