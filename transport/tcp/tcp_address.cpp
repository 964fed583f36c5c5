#include "transport/tcp/tcp_address.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <memory>
#include <mutex>
#include <netdb.h>
#include <netinet/in.h>
#include <system_error>
#include <thread>

#include "transport/system_error.hpp"

namespace mural {

namespace {

struct Lookup {
    int code = 0; // result of getaddrinfo
    int systemCode = 0;
    std::vector<TcpAddress> addresses;
};

Lookup lookUp(const std::string& host, uint16_t port, int flags) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = flags | AI_NUMERICSERV;
    addrinfo* list = nullptr;
    Lookup result;
    result.code = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list);
    result.systemCode = errno;
    if (result.code != 0) return result;
    for (const addrinfo* each = list; each != nullptr; each = each->ai_next) {
        TcpAddress address;
        std::memcpy(&address.storage, each->ai_addr, each->ai_addrlen);
        address.sizeBytes = each->ai_addrlen;
        result.addresses.push_back(address);
    }
    freeaddrinfo(list);
    return result;
}

Error lookupError(const std::string& text, const Lookup& lookup) {
    const std::string reason = lookup.code == EAI_SYSTEM ? errnoText(lookup.systemCode) : gai_strerror(lookup.code);
    return Error{text + ": cannot resolve the host: " + reason + "; check its name or use its address"};
}

// Shared by the waiting caller and the lookup thread; the last one frees it.
struct PendingLookup {
    std::mutex mutex;
    std::condition_variable finished;
    bool done = false;
    Lookup lookup;
};

// Returns false after the deadline; the thread then ends on its own.
bool lookUpOnThread(const std::string& host, uint16_t port, int flags, Deadline deadline, Lookup& into) {
    auto pending = std::make_shared<PendingLookup>();
    try {
        std::thread([pending, host, port, flags] {
            Lookup lookup = lookUp(host, port, flags);
            const std::lock_guard lock(pending->mutex);
            pending->lookup = std::move(lookup);
            pending->done = true;
            pending->finished.notify_one();
        }).detach();
    } catch (const std::system_error&) {
        into = lookUp(host, port, flags); // no thread available: look up without a deadline
        return true;
    }
    std::unique_lock lock(pending->mutex);
    while (!pending->done) {
        const int64_t leftNs = deadline.leftNs(kNsPerS);
        if (leftNs == 0) return false;
        pending->finished.wait_for(lock, std::chrono::nanoseconds(leftNs));
    }
    into = std::move(pending->lookup);
    return true;
}

} // namespace

Result<std::vector<TcpAddress>> resolveTcp(const std::string& host, uint16_t port, TcpRole role, Deadline deadline) {
    const std::string text = tcpText(host, port);
    const int flags = role == TcpRole::Listen ? AI_PASSIVE : 0;
    Lookup lookup = lookUp(host, port, flags | AI_NUMERICHOST);
    if (lookup.code == EAI_NONAME && !lookUpOnThread(host, port, flags, deadline, lookup)) {
        return Error{text + ": deadline passed while resolving the host; use its address"};
    }
    if (lookup.code != 0) return lookupError(text, lookup);
    return std::move(lookup.addresses);
}

std::string tcpText(const std::string& host, uint16_t port) { return "tcp://" + endpointText(host, port); }

std::string tcpText(const TcpAddress& address) {
    char host[NI_MAXHOST] = "?";
    getnameinfo(address.get(), address.sizeBytes, host, sizeof host, nullptr, 0, NI_NUMERICHOST);
    return tcpText(host, tcpPort(address));
}

uint16_t tcpPort(const TcpAddress& address) {
    if (address.family() == AF_INET) {
        return ntohs(reinterpret_cast<const sockaddr_in*>(&address.storage)->sin_port);
    }
    return ntohs(reinterpret_cast<const sockaddr_in6*>(&address.storage)->sin6_port);
}

TcpAddress localTcpAddress(int socket) {
    TcpAddress address;
    address.sizeBytes = sizeof address.storage;
    getsockname(socket, reinterpret_cast<sockaddr*>(&address.storage), &address.sizeBytes);
    return address;
}

TcpAddress peerTcpAddress(int socket) {
    TcpAddress address;
    address.sizeBytes = sizeof address.storage;
    getpeername(socket, reinterpret_cast<sockaddr*>(&address.storage), &address.sizeBytes);
    return address;
}

bool sameTcpAddress(const TcpAddress& a, const TcpAddress& b) {
    return a.sizeBytes == b.sizeBytes && std::memcmp(&a.storage, &b.storage, a.sizeBytes) == 0;
}

} // namespace mural
