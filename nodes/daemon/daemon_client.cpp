#include "nodes/daemon/daemon_client.hpp"

#include <array>
#include <cerrno>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "nodes/daemon/channel_socket.hpp"
#include "transport/system_error.hpp"
#include "transport/tcp/socket_address.hpp"
#include "transport/tcp/tcp_address.hpp"
#include "transport/tcp/tcp_connection.hpp"
#include "transport/tcp/tcp_race.hpp"

namespace mural {

namespace {

constexpr int64_t kConnectMs = 5'000; // for all addresses together; the same for name resolution
constexpr int64_t kProofMs = 10'000;
constexpr int64_t kSendMs = 10'000;

Result<FileDescriptor> connectTo(const DaemonClient& call) {
    std::string why = "the host has no address";
    std::vector<TcpAddress> addresses;
    for (const std::string& host : call.addresses) {
        auto resolved = resolveTcp(host, call.port, TcpRole::Connect, Deadline::inMs(kConnectMs));
        if (resolved)
            addresses.insert(addresses.end(), resolved->begin(), resolved->end());
        else
            why = resolved.error().message;
    }
    if (!addresses.empty()) {
        auto socket = connectRacing(addresses, Deadline::inMs(kConnectMs));
        if (socket && prepareTcpSocket(socket->get())) return socket;
        why = socket ? "the connection was closed immediately" : socket.error().message;
    }
    std::string endpoints;
    for (const std::string& host : call.addresses)
        endpoints += (endpoints.empty() ? "" : ", ") + endpointText(host, call.port);
    return Error{"cannot connect to " + endpoints + ": " + why + "; check that `mural node --wait` runs there"};
}

Result<void> writeAll(int fd, std::span<const std::byte> bytes) {
    for (size_t at = 0; at < bytes.size();) {
        const ssize_t n = ::write(fd, bytes.data() + at, bytes.size() - at);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return Error{"cannot write the node's output: " + errnoText(errno)};
        at += static_cast<size_t>(n);
    }
    return {};
}

} // namespace

Result<int> callNode(const DaemonClient& call) {
    auto socket = connectTo(call);
    if (!socket) return socket.error();
    ChannelSocket channel(std::move(*socket), SecureChannel::connecting("head", call.secret));
    if (auto r = channel.open(Deadline::inMs(kProofMs)); !r) return r.error();
    if (auto r = channel.send(commandMessage(call.arguments), Deadline::inMs(kSendMs)); !r) return r.error();
    bool input = true;
    while (true) {
        while (auto m = channel.next()) {
            if (m->kind == NodeMessageKind::Refused)
                return Error{"the daemon rejected the command: " + textOf(m->body)};
            if (m->kind == NodeMessageKind::Ended) return m->body.empty() ? 1 : std::to_integer<int>(m->body.front());
            if (m->kind != NodeMessageKind::Output && m->kind != NodeMessageKind::Errors) continue;
            if (auto r = writeAll(m->kind == NodeMessageKind::Output ? STDOUT_FILENO : STDERR_FILENO, m->body); !r)
                return r.error();
        }
        // A session has no time limit. TCP keepalive detects a lost head within 14 s.
        std::array<pollfd, 2> polled{{{channel.descriptor(), POLLIN, 0}, {input ? STDIN_FILENO : -1, POLLIN, 0}}};
        if (poll(polled.data(), polled.size(), -1) < 0 && errno != EINTR)
            return Error{"cannot wait for the node: " + errnoText(errno)};
        if (polled[0].revents != 0) {
            if (auto r = channel.fetch(); !r) {
                // Reads the queued messages first, because the process may have ended normally.
                for (auto m = channel.next(); m; m = channel.next())
                    if (m->kind == NodeMessageKind::Ended && !m->body.empty())
                        return std::to_integer<int>(m->body.front());
                return Error{"the connection to the daemon is lost: " + r.error().message};
            }
        }
        if (polled[1].revents != 0) {
            std::array<std::byte, 4096> piece;
            const ssize_t n = ::read(STDIN_FILENO, piece.data(), piece.size());
            if (n < 0 && errno == EINTR) continue;
            input = n > 0;
            const NodeMessage m = n > 0 ? NodeMessage{NodeMessageKind::Input, {piece.begin(), piece.begin() + n}}
                                        : NodeMessage{NodeMessageKind::InputEnd, {}};
            if (auto r = channel.send(m, Deadline::inMs(kSendMs)); !r) return r.error();
        }
    }
}

} // namespace mural
