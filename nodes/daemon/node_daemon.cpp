#include "nodes/daemon/node_daemon.hpp"

#include <array>
#include <cerrno>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <thread>

#include "common/log/log.hpp"
#include "nodes/daemon/remote_command.hpp"
#include "transport/tcp/socket_wait.hpp"
#include "transport/system_error.hpp"
#include "transport/tcp/tcp_address.hpp"
#include "transport/tcp/tcp_connection.hpp"

namespace mural {

namespace {

constexpr int kBacklog = 32;
constexpr unsigned kMaxConnections = 64;
constexpr int64_t kHeadProofMs = 5'000; // for the proof of the secret and for the command
constexpr int64_t kAnswerMs = 5'000;
constexpr int64_t kCommandsEndMs = 10'000; // for all commands, when the daemon stops

Result<FileDescriptor> listenAt(const std::string& text) {
    auto where = splitHostPort(text);
    if (!where) return where.error();
    // Without an address: all interfaces, with one socket for IPv4 and IPv6 where IPv6 exists.
    std::vector<std::string> hosts{where->host};
    if (where->host.empty()) hosts = {"::", "0.0.0.0"};
    std::string why;
    for (const std::string& host : hosts) {
        auto address = numericAddress(host, where->port);
        if (!address) return address.error();
        FileDescriptor fd(::socket(address->family(), SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        const int yes = 1, no = 0;
        (void)setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        if (address->family() == AF_INET6) (void)setsockopt(fd.get(), IPPROTO_IPV6, IPV6_V6ONLY, &no, sizeof no);
        if (fd.valid() && ::bind(fd.get(), address->get(), address->sizeBytes) == 0 &&
            ::listen(fd.get(), kBacklog) == 0)
            return fd;
        why = errnoText(errno);
    }
    return Error{"cannot listen at " + text + ": " + why + "; choose another --listen ADDRESS:PORT"};
}

// An IPv4 peer of an IPv6 socket appears as "::ffff:10.0.0.1".
std::string peerText(const SocketAddress& address) {
    constexpr std::string_view kMapping = "::ffff:";
    const std::string text = numericText(address);
    return text.starts_with(kMapping) ? text.substr(kMapping.size()) : text;
}

} // namespace

Result<std::unique_ptr<NodeDaemon>> NodeDaemon::open(const DaemonOptions& options) {
    auto socket = listenAt(options.listen);
    if (!socket) return socket.error();
    const uint16_t port = tcpPort(localTcpAddress(socket->get()));
    return std::unique_ptr<NodeDaemon>(new NodeDaemon(options, std::move(*socket), port));
}

bool NodeDaemon::enter(const std::string& peer) {
    const std::lock_guard lock(mutex_);
    if (!heads_.empty() && !heads_.contains(peer)) return false;
    ++heads_[peer];
    return true;
}

void NodeDaemon::leave(const std::string& peer) {
    const std::lock_guard lock(mutex_);
    if (--heads_[peer] == 0) heads_.erase(peer);
}

// Serves one connection on its own thread. The process that it starts ends with this thread.
void NodeDaemon::take(FileDescriptor socket, const std::string& peer) {
    const ChannelSecret secret = options_.secret;
    ChannelSocket channel(std::move(socket),
                          SecureChannel::accepting([secret](const std::string&) { return std::optional(secret); }));
    if (auto r = channel.open(Deadline::inMs(kHeadProofMs)); !r)
        return log::warning(log::Topic::Daemon, peer, " was not accepted: ", r.error().message);
    const auto refuse = [&](const std::string& why) {
        (void)channel.send(textMessage(NodeMessageKind::Refused, why), Deadline::inMs(kAnswerMs));
        log::warning(log::Topic::Daemon, peer, " was rejected: ", why);
    };
    auto command = channel.receive(Deadline::inMs(kHeadProofMs));
    if (!command) return log::warning(log::Topic::Daemon, peer, " sent no command: ", command.error().message);
    auto arguments = commandArguments(*command);
    if (!arguments || !isAllowedCommand(*arguments))
        return refuse("only render nodes can be started here; check that both run the same version");
    completeCommand(*arguments, peer);
    if (!enter(peer)) return refuse("another head uses this machine; try again after its session");
    log::info(log::Topic::Daemon, peer, " started a ", arguments->front(), " on this machine");
    auto how = runRemoteCommand(options_.executable, *arguments, channel, stop_);
    leave(peer);
    log::info(log::Topic::Daemon, peer, ": the ", arguments->front(), " ended: ", how ? *how : how.error().message);
}

Result<void> NodeDaemon::serve(int stopFd) {
    Result<void> result;
    while (true) {
        std::array<pollfd, 2> polled{{{socket_.get(), POLLIN, 0}, {stopFd, POLLIN, 0}}};
        if (poll(polled.data(), polled.size(), -1) < 0 && errno != EINTR) {
            result = Error{"cannot wait for heads: " + errnoText(errno)};
            break;
        }
        if (polled[1].revents != 0) break;
        SocketAddress from;
        from.sizeBytes = sizeof from.storage;
        FileDescriptor socket(accept4(socket_.get(), from.get(), &from.sizeBytes, SOCK_NONBLOCK | SOCK_CLOEXEC));
        if (!socket.valid()) {
            // A temporary error, such as too many open files.
            if (errno != EAGAIN && errno != EINTR && errno != ECONNABORTED) poll(nullptr, 0, 100);
            continue;
        }
        // bounds unauthenticated connections
        if (!prepareTcpSocket(socket.get()) || connections_ >= kMaxConnections) continue;
        ++connections_;
        try {
            std::thread([this, peer = peerText(from), s = std::move(socket)]() mutable {
                take(std::move(s), peer);
                --connections_;
            }).detach();
        } catch (const std::system_error&) {
            --connections_;
        }
    }
    stop_ = true;
    for (const Deadline end = Deadline::inMs(kCommandsEndMs); connections_ > 0 && !end.passed();) poll(nullptr, 0, 10);
    return result;
}

} // namespace mural
