#include "transport/rsp/io/control_link.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/write.hpp>

namespace mural::rsp {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {
constexpr std::chrono::seconds kGoodbye{2};
constexpr size_t kSealedBytes = 65'536; // offered messages sealed at once
// Unsent bytes that the kernel may hold. Its default of megabytes would delay later messages to a slow peer.
constexpr int kUnsentBytes = 131'072;
} // namespace

void ControlLink::start(Events events) {
    events_ = std::make_shared<const Events>(std::move(events));
    error_code ignored;
    socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
    static_cast<void>(
        setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes, sizeof kUnsentBytes));
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
    // fails only for messages that are too long, or before the channel is open; both are bugs
    static_cast<void>(channel_.send(encode(message)).ok());
    flush();
}

bool ControlLink::offer(const ControlMessage& message, size_t maxWaitingBytes) {
    if (ended_ || leaving_ || waitingBytes() > maxWaitingBytes) return false;
    offered_.push_back(encode(message));
    offeredBytes_ += offered_.back().size();
    flush();
    return true;
}

void ControlLink::dropOffered() {
    offered_.clear();
    offeredBytes_ = 0;
}

void ControlLink::sealOffered() {
    for (size_t bytes = 0; !offered_.empty() && bytes < kSealedBytes; offered_.pop_front()) {
        const auto& message = offered_.front();
        static_cast<void>(channel_.send(message).ok()); // as in send()
        bytes += message.size();
        offeredBytes_ -= message.size();
    }
}

void ControlLink::flush() {
    if (writing_.empty() && waiting_.empty()) sealOffered();
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
        if (failed) return self->close("the connection failed: " + failed.message());
        self->flush();
    });
}

void ControlLink::hangUp() {
    if (ended_ || leaving_) return;
    leaving_ = true;
    events_.reset();
    dropOffered();
    channel_.finish();
    goodbye_.emplace(socket_.get_executor());
    goodbye_->expires_after(kGoodbye);
    goodbye_->async_wait([self = shared_from_this()](const error_code&) { self->close(""); });
    flush();
}

void ControlLink::read() {
    socket_.async_read_some(asio::buffer(in_), [self = shared_from_this()](const error_code& failed, size_t bytes) {
        if (self->ended_) return;
        if (failed)
            return self->close(failed == asio::error::eof ? "the peer closed the connection without a goodbye"
                                                          : failed.message());
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
        if (!decoded) return close("it sent an invalid message, or one of another version");
        if (const auto events = events_) events->message(*decoded);
        if (ended_) return;
    }
    if (!good) {
        const auto alert = channel_.takeOutput(); // tells the peer why the connection ends; lost if the socket is full
        if (writing_.empty()) ::send(socket_.native_handle(), alert.data(), alert.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
        return close(good.error().message);
    }
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
