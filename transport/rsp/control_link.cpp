#include "transport/rsp/control_link.hpp"

#include <boost/asio/write.hpp>

namespace mural::rsp {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {
constexpr std::chrono::seconds kGoodbye{2};
} // namespace

void ControlLink::start(Events events) {
    events_ = std::make_shared<const Events>(std::move(events));
    error_code ignored;
    socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
    flush();
    read();
}

std::string ControlLink::peerAddress() const {
    error_code failed;
    const auto end = socket_.remote_endpoint(failed);
    return failed ? std::string() : end.address().to_string();
}

void ControlLink::send(const ControlMessage& message) {
    if (ended_ || leaving_) return;
    static_cast<void>(channel_.send(encode(message)).ok()); // too long or not open: our own fault, and never
    flush();
}

bool ControlLink::offer(const ControlMessage& message, size_t mostWaitingBytes) {
    if (waitingBytes() > mostWaitingBytes) return false;
    send(message);
    return true;
}

void ControlLink::flush() {
    const auto more = channel_.takeOutput();
    waiting_.insert(waiting_.end(), more.begin(), more.end());
    if (ended_ || !writing_.empty()) return;
    if (waiting_.empty()) {
        error_code ignored;
        if (leaving_) socket_.shutdown(Socket::shutdown_send, ignored);
        return;
    }
    writing_.swap(waiting_);
    asio::async_write(socket_, asio::buffer(writing_), [self = shared_from_this()](const error_code& failed, size_t) {
        self->writing_.clear();
        if (failed) return self->close("the connection broke: " + failed.message());
        self->flush();
    });
}

void ControlLink::hangUp() {
    if (ended_ || leaving_) return;
    leaving_ = true;
    events_.reset();
    channel_.finish();
    goodbye_.emplace(socket_.get_executor());
    goodbye_->expires_after(kGoodbye);
    goodbye_->async_wait([self = shared_from_this()](const error_code&) { self->close(""); });
    flush();
}

void ControlLink::read() {
    socket_.async_read_some(asio::buffer(in_), [self = shared_from_this()](const error_code& failed, size_t bytes) {
        if (self->ended_) return;
        if (failed) return self->close(failed == asio::error::eof ? "the peer broke off without a goodbye" : failed.message());
        self->took(bytes);
        if (!self->ended_) self->read();
    });
}

void ControlLink::took(size_t bytes) {
    std::vector<std::vector<std::byte>> messages;
    const auto good = channel_.input(std::span(in_).first(bytes), messages);
    if (channel_.open() && !std::exchange(wasOpen_, true)) {
        if (const auto events = events_) events->opened();
    }
    for (const auto& m : messages) {
        const auto decoded = decode(m);
        if (!decoded) return close("it sent what is no message of this version");
        if (const auto events = events_) events->message(*decoded);
        if (ended_) return;
    }
    if (!good) return close(good.error().message);
    flush();
    if (channel_.finished()) close("");
}

void ControlLink::close(const std::string& why) {
    if (std::exchange(ended_, true)) return;
    error_code ignored;
    socket_.close(ignored);
    if (goodbye_) goodbye_->cancel();
    if (const auto events = std::exchange(events_, nullptr)) events->closed(why);
}

} // namespace mural::rsp
