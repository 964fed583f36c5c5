// A connection to the control interface of the head, without blocking. Used by the thread of its io_context.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>

#include "common/base/result.hpp"

namespace mural::page {

class HeadLink : public std::enable_shared_from_this<HeadLink> {
public:
    // Receives the reply without its id: {"ok": …}. After the loss of the connection the reply is an error.
    using OnReply = std::function<void(nlohmann::json reply)>;
    using OnMessage = std::function<void(nlohmann::json message)>;
    using OnLost = std::function<void()>;

    // Connects at once, because the socket is on this machine. Errors: nobody listens, or another user does.
    static Result<std::shared_ptr<HeadLink>> connect(boost::asio::io_context& io, const std::string& path);

    // Starts to receive. The functions are called until close().
    void begin(OnMessage onMessage, OnLost onLost);
    void request(const std::string& operation, const nlohmann::json& arguments, OnReply onReply);
    void close();

private:
    using Socket = boost::asio::local::stream_protocol::socket;

    explicit HeadLink(Socket socket) : socket_(std::move(socket)) {}
    void receive();
    void take();
    void takeLine(std::string_view line);
    void send();
    void lose();

    Socket socket_;
    OnMessage onMessage_;
    OnLost onLost_;
    std::array<char, 65536> part_{};
    std::string received_;
    std::deque<std::string> unsent_; // the first is being sent
    std::map<int64_t, OnReply> waiting_;
    int64_t lastId_ = 0;
    bool isLost_ = false;
};

} // namespace mural::page
