// Creates TCP connections: listens and connects.
#include <cerrno>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/log/log.hpp"
#include "transport/tcp/socket_wait.hpp"
#include "transport/system_error.hpp"
#include "transport/tcp/tcp_address.hpp"
#include "transport/tcp/tcp_connection.hpp"

namespace mural {

namespace {

constexpr int kBacklog = 128;
constexpr int64_t kListenLookupMs = 5000;
constexpr int kSocketFlags = SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC;

class TcpListener final : public Listener {
public:
    TcpListener(FileDescriptor socket, std::string description)
        : socket_(std::move(socket)), description_(std::move(description)) {}

    Result<std::unique_ptr<Connection>> accept(Deadline deadline) override;
    [[nodiscard]] std::string describe() const override { return description_; }

private:
    FileDescriptor socket_;
    std::string description_;
};

// A peer that gives up before it is accepted is not an error of the listener.
bool passingTrouble(int code) {
    return code == EINTR || code == EAGAIN || code == EWOULDBLOCK || code == ECONNABORTED || code == EPROTO ||
           code == ENETDOWN || code == EHOSTUNREACH || code == ENETUNREACH;
}

Result<std::unique_ptr<Connection>> TcpListener::accept(Deadline deadline) {
    while (true) {
        FileDescriptor socket(accept4(socket_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
        if (socket.valid()) {
            if (!prepareTcpSocket(socket.get())) continue; // the peer has already gone
            log::debug(log::Topic::Transport, description_, ": ", tcpText(peerTcpAddress(socket.get())), " connected");
            return std::unique_ptr<Connection>(std::make_unique<TcpConnection>(std::move(socket)));
        }
        if (!passingTrouble(errno)) {
            return Error{description_ + ": accept: " + errnoText(errno) + "; close connections or listen again"};
        }
        if (waitForSocket(socket_.get(), POLLIN, deadline) == 0) {
            return Error{
                description_ +
                ": deadline passed without a connection; check that the peer was started and can connect to this port"};
        }
    }
}

Result<FileDescriptor> listenOn(const TcpAddress& address) {
    const std::string text = tcpText(address);
    FileDescriptor socket(::socket(address.family(), kSocketFlags, 0));
    if (!socket.valid()) return Error{text + ": socket: " + errnoText(errno)};
    const int on = 1;
    const int off = 0;
    setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (address.family() == AF_INET6) {
        setsockopt(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
    }
    if (bind(socket.get(), address.get(), address.sizeBytes) != 0 || ::listen(socket.get(), kBacklog) != 0) {
        return Error{text + ": cannot listen: " + errnoText(errno) + "; choose another port or address"};
    }
    return socket;
}

// Peers cannot connect to the wildcard address, so the description contains this host's name.
std::string listenerText(bool anyAddress, const TcpAddress& bound) {
    char name[256] = "";
    if (!anyAddress || gethostname(name, sizeof name - 1) != 0 || name[0] == 0) return tcpText(bound);
    return tcpText(name, tcpPort(bound));
}

// A connect to a free ephemeral port of the own host can connect to itself.
bool connectedToItself(int socket) { return sameTcpAddress(localTcpAddress(socket), peerTcpAddress(socket)); }

Result<FileDescriptor> connectTo(const TcpAddress& address, Deadline deadline) {
    const std::string text = tcpText(address);
    FileDescriptor socket(::socket(address.family(), kSocketFlags, 0));
    if (!socket.valid()) return Error{text + ": socket: " + errnoText(errno)};
    int code = 0;
    if (connect(socket.get(), address.get(), address.sizeBytes) != 0) {
        if (errno != EINPROGRESS && errno != EINTR) {
            code = errno;
        } else if (waitForSocket(socket.get(), POLLOUT, deadline) == 0) {
            return Error{text + ": deadline passed without a reply; check the address and the firewall"};
        } else {
            socklen_t sizeBytes = sizeof code;
            getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &code, &sizeBytes);
        }
    }
    if (code == 0 && connectedToItself(socket.get())) code = ECONNREFUSED;
    if (code == 0 && !prepareTcpSocket(socket.get())) code = errno;
    if (code != 0) {
        return Error{text + ": cannot connect: " + errnoText(code) + "; check that the peer listens there"};
    }
    return socket;
}

} // namespace

Result<std::unique_ptr<Listener>> listenTcp(const std::string& address, uint16_t port) {
    const bool anyAddress = address.empty() || address == "*";
    std::vector<TcpAddress> candidates;
    // "::" includes IPv4; without IPv6 in the kernel 0.0.0.0 remains.
    const std::vector<std::string> names =
        anyAddress ? std::vector<std::string>{"::", "0.0.0.0"} : std::vector<std::string>{address};
    for (const std::string& name : names) {
        auto found = resolveTcp(name, port, TcpRole::Listen, Deadline::inMs(kListenLookupMs));
        if (!found) return found.error();
        candidates.insert(candidates.end(), found->begin(), found->end());
    }
    Error first{tcpText(address, port) + ": no address to listen on; check the name"};
    for (size_t i = 0; i < candidates.size(); ++i) {
        auto socket = listenOn(candidates[i]);
        if (socket) {
            std::string text = listenerText(anyAddress, localTcpAddress(socket->get()));
            log::debug(log::Topic::Transport, text, ": listens");
            return std::unique_ptr<Listener>(std::make_unique<TcpListener>(std::move(*socket), std::move(text)));
        }
        if (i == 0) first = socket.error();
    }
    return first;
}

// Divides the remaining time among the host's addresses, so that one that does not answer (a dead IPv6 route) does not
// consume all of it.
Result<std::unique_ptr<Connection>> connectTcp(const std::string& host, uint16_t port, Deadline deadline) {
    auto addresses = resolveTcp(host, port, TcpRole::Connect, deadline);
    if (!addresses) return addresses.error();
    Error last{tcpText(host, port) + ": the host has no address; check its name"};
    for (size_t i = 0; i < addresses->size(); ++i) {
        const auto remaining = static_cast<int64_t>(addresses->size() - i);
        const int64_t shareMs = deadline.leftNs(3600 * kNsPerS) / kNsPerMs / remaining;
        auto socket = connectTo((*addresses)[i], remaining == 1 ? deadline : Deadline::inMs(shareMs));
        if (socket) {
            log::debug(log::Topic::Transport, "connected to ", host, " at ", tcpText((*addresses)[i]));
            return std::unique_ptr<Connection>(std::make_unique<TcpConnection>(std::move(*socket)));
        }
        log::debug(log::Topic::Transport, socket.error().message);
        last = socket.error();
    }
    return last;
}

} // namespace mural
