// A control connection: TCP, Asio's, with a secure channel in it. All of it on the thread that runs the io_context.
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

#include "transport/rsp/control_message.hpp"
#include "transport/secure_channel.hpp"

namespace mural::rsp {

class ControlLink : public std::enable_shared_from_this<ControlLink> {
public:
    using Socket = boost::asio::ip::tcp::socket;
    struct Events {
        std::function<void()> opened; // the peer knows the secret
        std::function<void(const ControlMessage&)> message;
        std::function<void(const std::string& why)> closed; // once, at the end; empty: the peer said goodbye
    };
    ControlLink(Socket socket, SecureChannel channel) : socket_(std::move(socket)), channel_(std::move(channel)) {}

    void start(Events events);
    void send(const ControlMessage& message);
    // For what may be lost: goes when nothing else does. Dropped, and false, if more than `mostWaitingBytes` wait for the
    // peer already.
    bool offer(const ControlMessage& message, size_t mostWaitingBytes);
    void dropOffered(); // what has not gone yet
    // Sends what is to be sent, nothing that is only offered, and ends when the peer has it, or does not take it within two
    // seconds; closed() is told nothing. A socket closed at once would lose the goodbye with the first lost segment, or with
    // what was not yet read.
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
    std::shared_ptr<const Events> events_; // shared: they may end this link while they run
    bool wasOpen_ = false;
    bool ended_ = false;
    bool leaving_ = false;
    std::optional<boost::asio::steady_timer> goodbye_;
    std::vector<std::byte> in_ = std::vector<std::byte>(65'536);
    std::vector<std::byte> writing_; // with the kernel
    std::vector<std::byte> waiting_;
    std::deque<std::vector<std::byte>> offered_; // not yet sealed: once sealed, none can be left out
    size_t offeredBytes_ = 0;
};

} // namespace mural::rsp
