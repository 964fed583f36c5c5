#include "tools/mural/network/probe_rate.hpp"

#include <algorithm>
#include <netinet/in.h>
#include <sys/socket.h>
#include <vector>

#include "transport/system_error.hpp"
#include "transport/tcp/socket_wait.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kRateConnectMs = 2'000;
constexpr int64_t kStallMs = 2'000; // without a byte
constexpr size_t kRatePieceBytes = 256 * 1024;

// Writes zeros for some time, then ends the direction.
void sendZeros(int fd, int64_t durationMs) {
    const std::vector<char> zeros(kRatePieceBytes);
    for (const Deadline end = Deadline::inMs(durationMs); !end.passed();) {
        if (waitForSocket(fd, POLLOUT, end) == 0) break;
        const ssize_t n = ::send(fd, zeros.data(), zeros.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n < 0 && errno != EAGAIN && errno != EINTR) break;
    }
    shutdown(fd, SHUT_WR);
}

// Reads to the end of the other direction.
RateMeasured readRate(int fd) {
    std::vector<char> piece(kRatePieceBytes);
    uint64_t bytes = 0;
    int64_t firstNs = 0;
    while (true) {
        if (waitForSocket(fd, POLLIN, Deadline::inMs(kStallMs)) == 0) return {0, "the connection carries no data"};
        const ssize_t n = ::recv(fd, piece.data(), piece.size(), MSG_DONTWAIT);
        if (n < 0 && (errno == EAGAIN || errno == EINTR)) continue;
        if (n < 0) return {0, errnoText(errno)};
        if (n == 0) break;
        if (firstNs == 0)
            firstNs = monotonicNowNs(); // bytes that arrived before are not counted
        else
            bytes += static_cast<uint64_t>(n);
    }
    const double seconds = static_cast<double>(monotonicNowNs() - firstNs) * 1e-9;
    if (firstNs == 0 || bytes == 0 || seconds <= 0) return {0, "too few bytes arrived"};
    return {static_cast<double>(bytes) / seconds, {}};
}

bool readToken(int fd, const std::string& token) {
    std::string got;
    while (got.size() < token.size()) {
        char part[kRateTokenBytes];
        if (waitForSocket(fd, POLLIN, Deadline::inMs(kStallMs)) == 0) return false;
        const ssize_t n = ::recv(fd, part, std::min(sizeof part, token.size() - got.size()), MSG_DONTWAIT);
        if (n < 0 && (errno == EAGAIN || errno == EINTR)) continue;
        if (n <= 0) return false;
        got.append(part, static_cast<size_t>(n));
    }
    return got == token;
}

} // namespace

Result<FileDescriptor> listenAnywhere(int family) {
    FileDescriptor fd(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    SocketAddress any;
    any.storage.ss_family = static_cast<sa_family_t>(family);
    any.sizeBytes = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
    constexpr int kBacklog = 256;
    if (!fd.valid() || ::bind(fd.get(), any.get(), any.sizeBytes) != 0 || ::listen(fd.get(), kBacklog) != 0)
        return Error{"cannot listen on a TCP port: " + errnoText(errno)};
    return fd;
}

Result<std::unique_ptr<RateListener>> RateListener::start(int family, std::string token, int64_t durationMs) {
    auto socket = listenAnywhere(family);
    if (!socket) return socket.error();
    const uint16_t port = tcpPort(localTcpAddress(socket->get()));
    return std::unique_ptr<RateListener>(new RateListener(std::move(*socket), port, std::move(token), durationMs));
}

RateListener::RateListener(FileDescriptor socket, uint16_t port, std::string token, int64_t durationMs)
    : socket_(std::move(socket)), port_(port), token_(std::move(token)), durationMs_(durationMs), thread_([this] {
          serve();
      }) {}

RateListener::~RateListener() {
    if (thread_.joinable()) thread_.join(); // ends by its deadlines
}

RateMeasured RateListener::finish() {
    if (thread_.joinable()) thread_.join();
    return received_;
}

void RateListener::serve() {
    received_.problem = "no connection arrived";
    for (const Deadline deadline = Deadline::inMs(kRateConnectMs + kStallMs); !deadline.passed();) {
        if (waitForSocket(socket_.get(), POLLIN, deadline) == 0) return;
        const FileDescriptor connection(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
        if (!connection.valid() || !readToken(connection.get(), token_)) continue;
        received_ = readRate(connection.get());
        sendZeros(connection.get(), durationMs_);
        return;
    }
}

Result<RateMeasured> measureRate(const SocketAddress& host, const std::string& token, int64_t durationMs) {
    const FileDescriptor fd(::socket(host.family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    int code = ::connect(fd.get(), host.get(), host.sizeBytes) == 0 ? 0 : errno;
    if (code == EINPROGRESS) {
        socklen_t size = sizeof code;
        if (waitForSocket(fd.get(), POLLOUT, Deadline::inMs(kRateConnectMs)) == 0)
            code = ETIMEDOUT;
        else if (getsockopt(fd.get(), SOL_SOCKET, SO_ERROR, &code, &size) != 0)
            code = errno;
    }
    if (code != 0) return Error{errnoText(code)};
    if (::send(fd.get(), token.data(), token.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(token.size()))
        return Error{"the connection accepts no data: " + errnoText(errno)};
    sendZeros(fd.get(), durationMs);
    return readRate(fd.get());
}

} // namespace mural::cli
