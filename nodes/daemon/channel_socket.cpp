#include "nodes/daemon/channel_socket.hpp"

#include <array>
#include <cerrno>
#include <sys/socket.h>

#include "transport/tcp/socket_wait.hpp"
#include "transport/system_error.hpp"

namespace mural {

Result<void> ChannelSocket::flush(Deadline deadline) {
    const auto bytes = channel_.takeOutput();
    for (size_t at = 0; at < bytes.size();) {
        const ssize_t n = ::send(socket_.get(), bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
        if (n >= 0) {
            at += static_cast<size_t>(n);
        } else if (errno == EAGAIN) {
            if (waitForSocket(socket_.get(), POLLOUT, deadline) == 0) return Error{"the peer does not read"};
        } else if (errno != EINTR) {
            return Error{"the connection is lost: " + errnoText(errno)};
        }
    }
    return {};
}

Result<void> ChannelSocket::fetch() {
    std::array<std::byte, 65'536> piece;
    while (true) {
        const ssize_t n = ::recv(socket_.get(), piece.data(), piece.size(), 0);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && errno == EAGAIN) return {};
        if (n < 0) return Error{"the connection is lost: " + errnoText(errno)};
        if (n == 0) return Error{"the peer has closed the connection"};
        std::vector<std::vector<std::byte>> records;
        auto r = channel_.input(std::span(piece).first(static_cast<size_t>(n)), records);
        for (const auto& record : records) {
            auto message = decodeNodeMessage(record);
            if (!message) return Error{"invalid message from the peer; check that both run the same version"};
            messages_.push_back(std::move(*message));
        }
        if (!r) return r.error();
        if (static_cast<size_t>(n) < piece.size()) return {};
    }
}

Result<void> ChannelSocket::open(Deadline deadline) {
    while (true) {
        if (auto r = flush(deadline); !r) return r;
        if (channel_.open()) return {};
        if (waitForSocket(socket_.get(), POLLIN, deadline) == 0) return Error{"the peer's secret differs"};
        if (auto r = fetch(); !r) {
            static_cast<void>(flush(Deadline::inMs(0)).ok()); // the alert tells the peer why the connection ends
            return r;
        }
    }
}

Result<void> ChannelSocket::send(const NodeMessage& message, Deadline deadline) {
    if (auto r = channel_.send(encode(message)); !r) return r;
    return flush(deadline);
}

std::optional<NodeMessage> ChannelSocket::next() {
    if (messages_.empty()) return {};
    NodeMessage message = std::move(messages_.front());
    messages_.pop_front();
    return message;
}

Result<NodeMessage> ChannelSocket::receive(Deadline deadline) {
    while (true) {
        if (auto message = next()) return std::move(*message);
        if (waitForSocket(socket_.get(), POLLIN, deadline) == 0) return Error{"no message from the peer in time"};
        if (auto r = fetch(); !r && messages_.empty()) return r.error();
    }
}

} // namespace mural
