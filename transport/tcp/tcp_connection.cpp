#include "transport/tcp/tcp_connection.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "transport/connection_error.hpp"
#include "transport/flush_grace.hpp"
#include "transport/tcp/socket_wait.hpp"
#include "transport/system_error.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural {

namespace {

constexpr size_t kBufferBytes = size_t{64} * 1024;

bool wouldBlock(int code) { return code == EAGAIN || code == EWOULDBLOCK; }

} // namespace

// Keep-alive detects a vanished host on an idle connection after 5 + 3 * 3 s.
bool prepareTcpSocket(int socket) {
    const int on = 1;
    const int idleSeconds = 5;
    const int intervalSeconds = 3;
    const int probes = 3;
    setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    setsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &idleSeconds, sizeof idleSeconds);
    setsockopt(socket, IPPROTO_TCP, TCP_KEEPINTVL, &intervalSeconds, sizeof intervalSeconds);
    setsockopt(socket, IPPROTO_TCP, TCP_KEEPCNT, &probes, sizeof probes);
    return setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on) == 0;
}

TcpConnection::TcpConnection(FileDescriptor socket)
    : socket_(std::move(socket)),
      description_(tcpText(peerTcpAddress(socket_.get()))),
      ownerPid_(getpid()),
      received_(std::make_unique<std::byte[]>(kBufferBytes)) {
    gathered_.reserve(kBufferBytes);
}

TcpConnection::~TcpConnection() { TcpConnection::close(); }

// A forked child has a copy of this object, whose destruction must not end the parent's connection.
void TcpConnection::close() {
    if (closed_.load() || getpid() != ownerPid_) return;
    if (const std::unique_lock lock(writeMutex_, std::try_to_lock); lock.owns_lock()) {
        size_t sentBytes = 0;
        sendAll({}, Deadline::inMs(0), sentBytes);
    }
    endStream();
}

void TcpConnection::endStream() {
    if (!closed_.exchange(true)) shutdown(socket_.get(), SHUT_RDWR); // wakes both sides of both ends
}

Result<void> TcpConnection::read(std::span<std::byte> into, Deadline deadline) {
    readTimedOut_.store(false, std::memory_order_relaxed);
    size_t done = 0;
    End end = closed_.load(std::memory_order_relaxed) ? End::ClosedHere : End::Done;
    while (end == End::Done) {
        done += takeBuffered(into.subspan(done));
        if (done == into.size()) {
            bytesRead_.fetch_add(done, std::memory_order_relaxed);
            return {};
        }
        size_t gotBytes = 0;
        end = receiveSome(into.subspan(done), deadline, gotBytes);
        done += gotBytes;
    }
    bytesRead_.fetch_add(done, std::memory_order_relaxed);
    if (end == End::DeadlinePassed && done == 0) readTimedOut_.store(true);
    return failed("read", end, readCode_, done, into.size());
}

size_t TcpConnection::takeBuffered(std::span<std::byte> into) {
    const size_t n = std::min(into.size(), receivedEnd_ - receivedAt_);
    if (n == 0) return 0;
    std::memcpy(into.data(), received_.get() + receivedAt_, n);
    receivedAt_ += n;
    return n;
}

// Receives into the caller's memory, and beyond that into the buffer, with one system call. Requires an empty buffer.
TcpConnection::End TcpConnection::receiveSome(std::span<std::byte> into, Deadline deadline, size_t& gotBytes) {
    while (true) {
        iovec parts[2] = {{into.data(), into.size()}, {received_.get(), kBufferBytes}};
        const ssize_t got = readv(socket_.get(), parts, 2);
        if (got > 0) {
            gotBytes = std::min(static_cast<size_t>(got), into.size());
            receivedAt_ = 0;
            receivedEnd_ = static_cast<size_t>(got) - gotBytes;
            return End::Done;
        }
        if (got < 0 && errno == EINTR) continue;
        if (got == 0 || !wouldBlock(errno)) {
            readCode_ = got == 0 ? 0 : errno;
            return closed_.load() ? End::ClosedHere : End::PeerGone;
        }
        const End end = waitReadable(deadline);
        if (end != End::Done) return end;
    }
}

TcpConnection::End TcpConnection::waitReadable(Deadline deadline) {
    return waitForSocket(socket_.get(), POLLIN, deadline) == 0 ? End::DeadlinePassed : End::Done;
}

// The peer's end counts even while the socket is full: it will accept no more data.
TcpConnection::End TcpConnection::waitWritable(Deadline deadline) {
    const short events = waitForSocket(socket_.get(), POLLOUT | POLLRDHUP, deadline);
    if (closed_.load(std::memory_order_relaxed)) return End::ClosedHere;
    if (events == 0) return End::DeadlinePassed;
    if ((events & POLLRDHUP) != 0 && (events & POLLOUT) == 0) {
        writeCode_ = 0;
        return End::PeerGone;
    }
    return End::Done;
}

Result<void> TcpConnection::write(std::span<const std::byte> bytes, Deadline deadline) {
    writeTimedOut_.store(false, std::memory_order_relaxed);
    const std::lock_guard lock(writeMutex_);
    lastWriteDeadline_ = deadline;
    if (closed_.load(std::memory_order_relaxed)) return failed("write", End::ClosedHere, 0, 0, bytes.size());
    size_t sentBytes = 0;
    if (gatheredBytes() + bytes.size() <= kBufferBytes) {
        gather(bytes);
    } else {
        const End end = sendAll(bytes, deadline, sentBytes);
        const bool restFits = end == End::DeadlinePassed && sentBytes > 0 && bytes.size() - sentBytes <= kBufferBytes;
        if (restFits) {
            gather(bytes.subspan(sentBytes)); // everything before has been sent
        } else if (end != End::Done) {
            if (end == End::DeadlinePassed && sentBytes == 0) writeTimedOut_.store(true);
            return failed("write", end, writeCode_, sentBytes, bytes.size());
        }
    }
    bytesWritten_.fetch_add(bytes.size(), std::memory_order_relaxed);
    return {};
}

void TcpConnection::gather(std::span<const std::byte> bytes) {
    if (gathered_.size() + bytes.size() > kBufferBytes) {
        gathered_.erase(gathered_.begin(), gathered_.begin() + static_cast<ptrdiff_t>(gatheredAt_));
        gatheredAt_ = 0;
    }
    gathered_.insert(gathered_.end(), bytes.begin(), bytes.end());
}

ssize_t TcpConnection::sendOnce(std::span<const std::byte> bytes) {
    iovec parts[2] = {{gathered_.data() + gatheredAt_, gatheredBytes()},
                      {const_cast<std::byte*>(bytes.data()), bytes.size()}};
    msghdr message{};
    message.msg_iov = parts;
    message.msg_iovlen = 2;
    return sendmsg(socket_.get(), &message, MSG_NOSIGNAL);
}

TcpConnection::End TcpConnection::sendAll(std::span<const std::byte> bytes, Deadline deadline, size_t& sentBytes) {
    while (gatheredBytes() + bytes.size() - sentBytes != 0) {
        const ssize_t sent = sendOnce(bytes.subspan(sentBytes));
        if (sent >= 0) {
            const size_t ofGathered = std::min(static_cast<size_t>(sent), gatheredBytes());
            gatheredAt_ += ofGathered;
            sentBytes += static_cast<size_t>(sent) - ofGathered;
            continue;
        }
        if (errno == EINTR) continue;
        if (!wouldBlock(errno)) {
            writeCode_ = errno;
            return closed_.load() ? End::ClosedHere : End::PeerGone;
        }
        const End end = waitWritable(deadline);
        if (end != End::Done) return end;
    }
    gathered_.clear();
    gatheredAt_ = 0;
    return End::Done;
}

void TcpConnection::flush() {
    const std::lock_guard lock(writeMutex_);
    if (closed_.load(std::memory_order_relaxed) || gatheredBytes() == 0) return;
    const bool longer = lastWriteDeadline_.leftNs() > kFlushGraceMs * kNsPerMs;
    size_t sentBytes = 0;
    const End end = sendAll({}, longer ? lastWriteDeadline_ : Deadline::inMs(kFlushGraceMs), sentBytes);
    if (end == End::DeadlinePassed) writeTimedOut_.store(true);
}

NetworkPath TcpConnection::path() const {
    constexpr size_t kTcpHeadBytes = 20;
    constexpr size_t kTimestampBytes = 12; // per segment, if both ends use timestamps
    constexpr size_t kUdpHeadBytes = 8;
    tcp_info info{};
    socklen_t sizeBytes = sizeof info;
    if (getsockopt(socket_.get(), IPPROTO_TCP, TCP_INFO, &info, &sizeBytes) != 0) return {};
    return {numericText(localTcpAddress(socket_.get())),
            info.tcpi_snd_mss + (info.tcpi_options & TCPI_OPT_TIMESTAMPS ? kTimestampBytes : 0) + kTcpHeadBytes -
                kUdpHeadBytes};
}

bool TcpConnection::timedOut() const { return !closed_ && (readTimedOut_ || writeTimedOut_); }

bool TcpConnection::alive() const {
    if (closed_) return false;
    pollfd poller{socket_.get(), POLLRDHUP, 0};
    return poll(&poller, 1, 0) <= 0 || (poller.revents & (POLLRDHUP | POLLHUP | POLLERR)) == 0;
}

// A partially transferred message cannot be repaired: the connection ends, which informs the peer.
Error TcpConnection::failed(const char* verb, End end, int code, size_t doneBytes, size_t wantedBytes) {
    const bool usable = end == End::PeerGone || (end == End::DeadlinePassed && doneBytes == 0);
    if (!usable) endStream();
    std::string reason = ending::kPeerGone;
    if (end == End::PeerGone && code != 0) reason += " (" + errnoText(code) + ")";
    if (end == End::ClosedHere) reason = ending::kClosedHere;
    if (end == End::DeadlinePassed) reason = usable ? ending::kIdle : ending::kCutInHalf;
    return connectionError(description_, verb, doneBytes, wantedBytes, reason);
}

} // namespace mural
