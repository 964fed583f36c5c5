// A control connection: an Asio TCP socket with a secure channel. All methods run on the thread of the io_context.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "transport/rsp/wire/control_message.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural::rsp {

class ControlLink : public std::enable_shared_from_this<ControlLink> {
public:
    using Socket = boost::asio::ip::tcp::socket;
    struct Events {
        std::function<void()> opened; // the peer has proven that it knows the secret
        std::function<void(const ControlMessage&)> message;
        std::function<void(const std::string& why)> closed; // once, at the end; empty: the peer left in order
    };
    ControlLink(Socket socket, SecureChannel channel) : socket_(std::move(socket)), channel_(std::move(channel)) {}

    void start(Events events);
    void send(const ControlMessage& message);
    // Queues a message that may be lost, with lower priority than send(). Returns false and drops it if more than
    // `maxWaitingBytes` are queued.
    bool offer(const ControlMessage& message, size_t maxWaitingBytes);
    void dropOffered(); // drops queued messages that are not sealed yet
    // Sends queued messages, except offered ones, and closes when the peer has received them, or after two seconds.
    // Does not call closed(). An immediate close could lose the goodbye with a lost segment or with unread data.
    void hangUp();
    [[nodiscard]] bool ended() const { return ended_; }
    [[nodiscard]] std::string peerAddress() const;
    [[nodiscard]] const std::string& name() const { return channel_.name(); }
    [[nodiscard]] size_t waitingBytes() const { return writing_.size() + waiting_.size() + offeredBytes_; }

private:
    void flush();
    void sealOffered();
    void read();
    void took(size_t bytes);
    void close(const std::string& why);

    Socket socket_;
    SecureChannel channel_;
    std::shared_ptr<const Events> events_; // shared, because a callback may destroy this link
    bool wasOpen_ = false;
    bool ended_ = false;
    bool leaving_ = false;
    std::optional<boost::asio::steady_timer> goodbye_;
    std::vector<std::byte> in_ = std::vector<std::byte>(65'536);
    std::vector<std::byte> writing_; // passed to the kernel
    std::vector<std::byte> waiting_;
    std::deque<std::vector<std::byte>> offered_; // not sealed yet: sealed messages cannot be dropped
    size_t offeredBytes_ = 0;
};

} // namespace mural::rsp
