#include "interposer/process/handshake.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/base/clock.hpp"
#include "interposer/diagnostics/log.hpp"
#include "streamcodec/registry_digest.hpp"

namespace mural {

namespace {

constexpr int64_t kPatienceNs = 30 * kNsPerS;

class OwnedFd {
public:
    explicit OwnedFd(int fd = -1) : fd_(fd) {}
    ~OwnedFd() {
        if (fd_ >= 0) close(fd_);
    }
    OwnedFd(const OwnedFd&) = delete;
    OwnedFd& operator=(const OwnedFd&) = delete;
    [[nodiscard]] int get() const { return fd_; }
    void reset(int fd) {
        if (fd_ >= 0) close(fd_);
        fd_ = fd;
    }

private:
    int fd_;
};

// Transfers data despite the program's signals, which may interrupt any call. A fast timer may interrupt every call.
class Transfer {
public:
    explicit Transfer(int socket) : socket_(socket), endNs_(monotonicNowNs() + kPatienceNs) {}

    // move(at, bytes) does one non-blocking send or receive and returns its result.
    template <class Move> bool all(void* data, size_t bytes, short event, Move&& move) const {
        auto* at = static_cast<char*>(data);
        while (bytes > 0) {
            const ssize_t n = move(at, bytes);
            if (n > 0) {
                at += n;
                bytes -= static_cast<size_t>(n);
            } else if (n == 0 || !isTransient(errno) || !waitFor(event)) {
                return false;
            }
        }
        return true;
    }
    bool send(const void* data, size_t bytes) const {
        return all(const_cast<void*>(data), bytes, POLLOUT,
                   [this](char* at, size_t left) { return ::send(socket_, at, left, MSG_NOSIGNAL | MSG_DONTWAIT); });
    }
    // Stores a descriptor that arrives with the bytes in `passed`.
    bool receive(void* into, size_t bytes, OwnedFd* passed) const {
        return all(into, bytes, POLLIN, [&](char* at, size_t left) { return receiveSome(at, left, passed); });
    }

private:
    static bool isTransient(int error) { return error == EINTR || error == EAGAIN || error == EWOULDBLOCK; }

    [[nodiscard]] bool waitFor(short event) const {
        const int64_t leftNs = endNs_ - monotonicNowNs();
        pollfd poller{socket_, event, 0};
        return leftNs > 0 &&
               (poll(&poller, 1, static_cast<int>(leftNs / kNsPerMs) + 1) > 0 || monotonicNowNs() < endNs_);
    }

    ssize_t receiveSome(char* at, size_t bytes, OwnedFd* passed) const {
        alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
        iovec part{at, bytes};
        msghdr message{};
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        message.msg_control = control;
        message.msg_controllen = sizeof control;
        const ssize_t n = recvmsg(socket_, &message, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
        for (cmsghdr* c = n > 0 ? CMSG_FIRSTHDR(&message) : nullptr; c; c = CMSG_NXTHDR(&message, c)) {
            int fd = -1;
            if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_RIGHTS) continue;
            std::memcpy(&fd, CMSG_DATA(c), sizeof fd);
            if (passed)
                passed->reset(fd);
            else
                close(fd);
        }
        return n;
    }

    const int socket_;
    const int64_t endNs_;
};

// Adds a space before and after the text, so that every name has a space on both sides.
char* receiveText(const Transfer& transfer, uint32_t bytes) {
    auto* text = static_cast<char*>(std::malloc(size_t{bytes} + 3));
    if (!text) return nullptr;
    text[0] = ' ';
    if (!transfer.receive(text + 1, bytes, nullptr)) bytes = 0;
    text[bytes + 1] = ' ';
    text[bytes + 2] = 0;
    return text;
}

// The kernel drops a descriptor on its way if the process has no free number for it.
void reportMissingDescriptor() {
    rlimit limit{};
    getrlimit(RLIMIT_NOFILE, &limit);
    say("no file descriptor for the memory shared with the head (limit: %llu): raise ulimit -n; this program is not "
        "captured",
        static_cast<unsigned long long>(limit.rlim_cur));
}

// Maps the shared memory. A forked child must not write there, so the kernel excludes the mapping from children.
capture::CaptureHeader* mapMemory(int memory) {
    const off_t size = lseek(memory, 0, SEEK_END);
    void* const mapping =
        size > 0 ? mmap(nullptr, static_cast<size_t>(size), PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0) : MAP_FAILED;
    if (mapping == MAP_FAILED) {
        say("cannot map %ld bytes shared with the head (%s): raise ulimit -v or free memory; this program is not "
            "captured",
            static_cast<long>(size), std::strerror(errno));
        return nullptr;
    }
    if (madvise(mapping, static_cast<size_t>(size), MADV_DONTFORK) != 0) {
        say("cannot exclude forked children from the memory shared with the head (%s); this program is not captured",
            std::strerror(errno));
        munmap(mapping, static_cast<size_t>(size));
        return nullptr;
    }
    return static_cast<capture::CaptureHeader*>(mapping);
}

} // namespace

bool shakeHands(int socket, Handshake& result) {
    const OwnedFd closing(socket);
    const Transfer transfer(socket);
    const capture::Hello hello{capture::kMagic, capture::kVersion, registryDigest(), getpid(),
                               capture::ProgramKind::Captured};
    OwnedFd memory;
    capture::Welcome& welcome = result.welcome;
    if (!transfer.send(&hello, sizeof hello) || !transfer.receive(&welcome, sizeof welcome, &memory)) {
        say("the head does not reply (%s); this program is not captured",
            errno ? std::strerror(errno) : "it closed the connection");
        return false;
    }
    if (welcome.magic != capture::kMagic || welcome.version != capture::kVersion) {
        say("the head uses another version of the protocol: install capture library and mural from one build; this "
            "program is not captured");
        return false;
    }
    result.extensions = receiveText(transfer, welcome.extensionBytes);
    if (welcome.refused)
        say("not captured: %s", result.extensions ? result.extensions + 1 : "the head rejected it");
    else if (memory.get() < 0)
        reportMissingDescriptor();
    else if (result.extensions)
        result.header = mapMemory(memory.get());
    if (result.header) return true;
    std::free(result.extensions);
    result.extensions = nullptr;
    return false;
}

} // namespace mural
