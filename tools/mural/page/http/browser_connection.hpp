// One connection of a browser: HTTP requests, then perhaps a WebSocket. A template over the stream, which has TLS or
// not.
#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include "tools/mural/page/http/connection_site.hpp"

namespace mural::page {

namespace beast = boost::beast;
namespace asio = boost::asio;

// TCP and Unix sockets alike.
using PlainStream = beast::basic_stream<asio::generic::stream_protocol>;
using TlsStream = beast::ssl_stream<PlainStream>;

inline constexpr std::string_view kSubprotocol = "mural.v1";
inline constexpr std::chrono::seconds kHttpPatience{30}, kTlsPatience{10};

// The WebSocket of a viewer. Keeps itself alive while it is open.
template <class Stream>
class BrowserSocket : public ViewerSocket, public std::enable_shared_from_this<BrowserSocket<Stream>> {
public:
    static constexpr size_t kMaxUnsentBytes = size_t{8} << 20;

    BrowserSocket(Stream stream, ConnectionSite& site, std::string address, std::shared_ptr<void> slot)
        : socket_(std::move(stream)),
          site_(site),
          address_(std::move(address)),
          slot_(std::move(slot)),
          closeTimer_(socket_.get_executor()) {}

    ~BrowserSocket() override {
        if (viewer_ != 0) site_.left(viewer_);
    }

    void accept(beast::http::request<beast::http::string_body> request) {
        beast::get_lowest_layer(socket_).expires_never();
        // Beast sends a ping after half of the idle time.
        socket_.set_option(beast::websocket::stream_base::timeout{kTlsPatience, kHttpPatience, true});
        socket_.set_option(beast::websocket::stream_base::decorator([](beast::websocket::response_type& response) {
            response.set(beast::http::field::server, "mural");
            response.set(beast::http::field::sec_websocket_protocol, std::string(kSubprotocol));
        }));
        socket_.read_message_max(kMaxTextMessageBytes);
        const auto kept = std::make_shared<decltype(request)>(std::move(request)); // until the handshake is over
        socket_.async_accept(*kept, [self = this->shared_from_this(), kept](beast::error_code error) {
            if (error) return;
            self->viewer_ = self->site_.join(*self, self->address_);
            if (self->viewer_ == 0) self->close(kCloseTooMany, "the page has as many viewers as it permits");
            self->read();
        });
    }

    void sendText(std::string text) override { push({true, std::move(text), nullptr}); }
    void sendBinary(std::string header, std::shared_ptr<const std::string> payload) override {
        push({false, std::move(header), std::move(payload)});
    }

    void close(uint16_t code, const std::string& why) override {
        if (isClosing_) return;
        isClosing_ = true;
        viewer_ = 0; // the hub has forgotten this viewer
        reason_ = beast::websocket::close_reason(beast::websocket::close_code(code), why);
        // A viewer that reads nothing would delay the close.
        closeTimer_.expires_after(std::chrono::milliseconds(800));
        closeTimer_.async_wait([self = this->shared_from_this()](beast::error_code error) {
            if (!error) self->abort();
        });
        if (queue_.empty()) sendClose();
    }

private:
    struct Message {
        bool isText = true;
        std::string head;
        std::shared_ptr<const std::string> payload;
        [[nodiscard]] size_t size() const { return head.size() + (payload ? payload->size() : 0); }
    };

    void push(Message message) {
        if (isClosing_ || isOver_ || isTooSlow_) return;
        unsentBytes_ += message.size();
        if (unsentBytes_ > kMaxUnsentBytes) {
            isTooSlow_ = true;
            // Later, because the hub may be in a loop over its viewers.
            return asio::post(socket_.get_executor(), [self = this->shared_from_this()] { self->abort(); });
        }
        queue_.push_back(std::move(message));
        if (queue_.size() == 1) write();
    }

    void write() {
        const Message& message = queue_.front();
        socket_.text(message.isText);
        const std::array<asio::const_buffer, 2> buffers = {
            asio::buffer(message.head), message.payload ? asio::buffer(*message.payload) : asio::const_buffer()};
        socket_.async_write(buffers, [self = this->shared_from_this()](beast::error_code error, size_t) {
            if (error) return self->over();
            self->unsentBytes_ -= self->queue_.front().size();
            self->queue_.pop_front();
            if (!self->queue_.empty()) return self->write();
            if (self->isClosing_) self->sendClose();
        });
    }

    void read() {
        socket_.async_read(buffer_, [self = this->shared_from_this()](beast::error_code error, size_t) {
            if (error) return self->over();
            if (self->isClosing_) {
                self->buffer_.consume(self->buffer_.size());
                return self->read(); // until the peer's close frame
            }
            if (!self->socket_.got_text()) {
                const int viewer = std::exchange(self->viewer_, 0);
                self->site_.left(viewer);
                self->close(1003, "a viewer sends text only");
            } else {
                const std::string text = beast::buffers_to_string(self->buffer_.data());
                self->site_.received(self->viewer_, text);
            }
            self->buffer_.consume(self->buffer_.size());
            self->read();
        });
    }

    void sendClose() {
        socket_.async_close(reason_, [self = this->shared_from_this()](beast::error_code) { self->over(); });
    }

    void abort() {
        beast::error_code ignored;
        beast::get_lowest_layer(socket_).socket().close(ignored);
        over();
    }

    void over() {
        if (std::exchange(isOver_, true)) return;
        closeTimer_.cancel();
        if (const int viewer = std::exchange(viewer_, 0); viewer != 0) site_.left(viewer);
    }

    beast::websocket::stream<Stream> socket_;
    ConnectionSite& site_;
    const std::string address_;
    const std::shared_ptr<void> slot_; // counts the connections
    asio::steady_timer closeTimer_;
    beast::flat_buffer buffer_;
    std::deque<Message> queue_; // the first is being sent
    size_t unsentBytes_ = 0;
    int viewer_ = 0; // 0: not joined, or forgotten by the hub
    bool isClosing_ = false, isOver_ = false, isTooSlow_ = false;
    beast::websocket::close_reason reason_;
};

template <class Stream> class BrowserConnection : public std::enable_shared_from_this<BrowserConnection<Stream>> {
public:
    BrowserConnection(Stream stream, ConnectionSite& site, std::string address, std::shared_ptr<void> slot)
        : stream_(std::move(stream)), site_(site), address_(std::move(address)), slot_(std::move(slot)) {}

    void begin() {
        if constexpr (std::is_same_v<Stream, TlsStream>) {
            beast::get_lowest_layer(stream_).expires_after(kTlsPatience);
            stream_.async_handshake(asio::ssl::stream_base::server,
                                    [self = this->shared_from_this()](beast::error_code error) {
                                        if (!error) self->read();
                                    });
        } else {
            read();
        }
    }

private:
    using Parser = beast::http::request_parser<beast::http::string_body>;
    using Response = beast::http::response<beast::http::string_body>;

    void read() {
        parser_.emplace();
        parser_->header_limit(kMaxHeaderBytes);
        parser_->body_limit(kMaxBodyBytes);
        beast::get_lowest_layer(stream_).expires_after(kHttpPatience);
        beast::http::async_read(
            stream_, buffer_, *parser_,
            [self = this->shared_from_this()](beast::error_code error, size_t) { self->take(error); });
    }

    void take(beast::error_code error) {
        namespace http = beast::http;
        if (error == http::error::end_of_stream) return end();
        if (error == http::error::body_limit) return refuse(413, "the body is larger than 1 MiB");
        if (error == http::error::header_limit) return refuse(431, "the header is larger than 8 KiB");
        if (error.category() == http::make_error_code(http::error::bad_method).category())
            return refuse(400, "this is no valid request of HTTP/1.1");
        if (error) return; // the connection is lost, or silent for too long
        http::request<http::string_body> message = parser_->release();
        HttpRequest request;
        request.method = std::string(message.method_string());
        request.path = std::string(message.target());
        request.host = std::string(message[http::field::host]);
        request.origin = std::string(message[http::field::origin]);
        request.authorization = std::string(message[http::field::authorization]);
        request.address = address_;
        version_ = message.version();
        isHead_ = message.method() == http::verb::head;
        isKept_ = message.keep_alive();
        if (beast::websocket::is_upgrade(message)) return upgrade(request, std::move(message));
        request.body = std::move(message.body());
        beast::get_lowest_layer(stream_).expires_never(); // the head has deadlines of its own
        site_.handle(std::move(request),
                     [self = this->shared_from_this()](HttpResponse response) { self->write(std::move(response)); });
    }

    void upgrade(const HttpRequest& request, beast::http::request<beast::http::string_body> message) {
        isKept_ = false;
        if (request.path != "/ws") return refuse(404, "the WebSocket of the page is /ws");
        if (auto refused = site_.refusal(request)) return write(std::move(*refused));
        const std::string offered(message[beast::http::field::sec_websocket_protocol]);
        if (!beast::http::token_list(offered).exists(std::string(kSubprotocol)))
            return refuse(400, "the subprotocol of the WebSocket must be mural.v1");
        std::make_shared<BrowserSocket<Stream>>(std::move(stream_), site_, address_, slot_)->accept(std::move(message));
    }

    void refuse(unsigned status, const char* line) {
        isKept_ = false;
        write({status, "text/plain; charset=utf-8", std::string(line) + "\n", {}});
    }

    void write(HttpResponse answer) {
        namespace http = beast::http;
        const auto response = std::make_shared<Response>(static_cast<http::status>(answer.status), version_);
        response->set(http::field::server, "mural");
        response->set(http::field::content_type, answer.type);
        for (const auto& [name, value] : site_.commonHeaders()) response->set(name, value);
        for (const auto& [name, value] : answer.headers) response->set(name, value);
        response->keep_alive(isKept_);
        response->body() = std::move(answer.body);
        response->prepare_payload();
        if (isHead_) response->body().clear(); // its length stays in the header
        beast::get_lowest_layer(stream_).expires_after(kHttpPatience);
        http::async_write(stream_, *response,
                          [self = this->shared_from_this(), response](beast::error_code error, size_t) {
                              if (error) return;
                              if (self->isKept_) return self->read();
                              self->end();
                          });
    }

    void end() {
        if constexpr (std::is_same_v<Stream, TlsStream>) {
            beast::get_lowest_layer(stream_).expires_after(kTlsPatience);
            stream_.async_shutdown([self = this->shared_from_this()](beast::error_code) {});
        } else {
            beast::error_code ignored;
            stream_.socket().shutdown(asio::socket_base::shutdown_send, ignored);
        }
    }

    Stream stream_;
    ConnectionSite& site_;
    const std::string address_;
    const std::shared_ptr<void> slot_; // counts the connections
    beast::flat_buffer buffer_;
    std::optional<Parser> parser_;
    unsigned version_ = 11;
    bool isHead_ = false, isKept_ = true;
};

// Serves a new connection. Each kind of stream is compiled in a source of its own, because Beast's templates are large.
void servePlain(PlainStream stream, ConnectionSite& site, std::string address, std::shared_ptr<void> slot);
void serveTls(TlsStream stream, ConnectionSite& site, std::string address, std::shared_ptr<void> slot);

} // namespace mural::page
