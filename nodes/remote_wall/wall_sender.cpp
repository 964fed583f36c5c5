#include "nodes/remote_wall/wall_sender.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "common/log/log.hpp"
#include "nodes/output/eye_pair.hpp"
#include "nodes/output/reduce_picture.hpp"
#include "transport/secure/secure_connection.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural::remote {

namespace {

constexpr int64_t kConnectMs = 3'000, kProofMs = 5'000, kGreetMs = 5'000;
constexpr int64_t kWriteMs = 10'000;
constexpr int64_t kReadSliceMs = 250;
constexpr int64_t kSilenceNs = 10 * kNsPerS; // without an acknowledgement
constexpr std::chrono::milliseconds kWorkSlice{250};
constexpr int kNiceSender = 10;                   // below the threads that draw, assemble and show
constexpr uint64_t kMinTransferBytes = 64 * 1024; // smaller ones measure the buffers of sockets

// Whether a failed handshake fails again: its text then names the difference between both ends
// (transport/secure/secure_channel.cpp). Otherwise the peer ended.
bool isLasting(const Error& handshake) { return handshake.message.find("both ends") != std::string::npos; }

void beNice() { setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNiceSender); }

} // namespace

WallSender::WallSender(WallSenderConfig config)
    : config_(std::move(config)), retry_(monotonicNowNs()), window_(config_.target.rate), thread_([this] { run(); }) {}

WallSender::~WallSender() { end(); }

void WallSender::offer(uint64_t frame, std::shared_ptr<const OwnedPicture> picture) {
    Offered next{frame, std::move(picture)};
    const std::lock_guard lock(mutex_);
    if (stop_) return;
    std::swap(latest_, next); // the earlier picture is freed after the lock
    changed_.notify_all();
}

bool WallSender::finish(Deadline deadline) {
    std::unique_lock lock(mutex_);
    const auto isDone = [this] {
        return !isConnected_ || !latest_.picture || (sentFrame_ == latest_.frame && !isSending_ && window_.isIdle());
    };
    changed_.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kNsPerS * 60)), isDone);
    return isDone();
}

void WallSender::requestEnd() {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    latest_ = {};
    if (link_ && isSending_) link_->close(); // a stopped wall may block it
    changed_.notify_all();
}

void WallSender::end() {
    requestEnd();
    if (thread_.joinable()) thread_.join();
}

bool WallSender::isStopping() {
    const std::lock_guard lock(mutex_);
    return stop_;
}

std::string WallSender::place() const { return endpointText(config_.target.host, config_.target.port); }

void WallSender::run() {
    beNice();
    while (!isStopping()) {
        {
            std::unique_lock lock(mutex_);
            const int64_t leftNs = retry_.nextNs() - monotonicNowNs();
            if (leftNs > 0) changed_.wait_for(lock, std::chrono::nanoseconds(leftNs), [this] { return stop_; });
            if (stop_) return;
        }
        Failure failure;
        auto connected = connect(failure);
        if (!connected) {
            const int64_t nowNs = monotonicNowNs();
            retry_.failed(nowNs);
            report(failure, nowNs);
            continue;
        }
        log::info(log::Topic::Output, "remote wall ", config_.target.name, ": \"", connected->wall.name, "\" at ",
                  place(), " shows the pictures");
        failure = serve(*connected);
        if (config_.onGone) config_.onGone();
        const int64_t nowNs = monotonicNowNs();
        if (isStopping()) return;
        if (std::exchange(hasShown_, false))
            retry_.lost(nowNs);
        else
            retry_.failed(nowNs); // otherwise a wall that rejects every picture would be tried without a pause
        log::debug(log::Topic::Output, "remote wall ", config_.target.name, " is gone: ", failure.reason);
        report(failure, nowNs);
    }
}

void WallSender::report(const Failure& failure, int64_t nowNs) {
    if (!retry_.takeReport(nowNs, failure.isFinal)) return;
    log::warning(log::Topic::Output, "remote wall ", config_.target.name, ": no picture reaches ", place(), ": ",
                 failure.reason, "; the session continues and tries again");
}

std::optional<WallSender::Connected> WallSender::connect(Failure& failure) {
    const auto fail = [&](const std::string& reason, bool isFinal) {
        failure = {reason, isFinal};
        return std::nullopt;
    };
    auto plain = connectTcp(config_.target.host, config_.target.port, Deadline::inMs(kConnectMs));
    if (!plain) return fail(plain.error().message + " (mural show --listen)", false);
    const Deadline proof = Deadline::inMs(kProofMs);
    auto secure = SecureConnection::connecting(std::move(*plain), config_.target.name, config_.secret, proof);
    if (!secure && proof.passed()) return fail("it does not answer; check that mural show is not stopped", false);
    if (!secure) return fail(secure.error().message, isLasting(secure.error()));
    Connected connected{std::make_unique<WallLink>(std::move(*secure)), {}};
    Hello hello;
    hello.name = config_.target.name;
    hello.codec = config_.target.codec;
    hello.session = config_.session;
    hello.eyes = config_.hasPairs ? 2 : 1;
    hello.tile = config_.target.tile;
    if (auto sent = connected.link->send(hello, Deadline::inMs(kGreetMs)); !sent)
        return fail(sent.error().message, false);
    auto reply = connected.link->receive(Deadline::inMs(kGreetMs));
    if (!reply) return fail(reply.error().message, false);
    if (!*reply) return fail("it does not answer; check that mural show is not stopped", false);
    if (const auto* bye = std::get_if<Bye>(&**reply)) return fail(bye->reason, bye->isFinal);
    const auto* wall = std::get_if<Hello>(&**reply);
    if (!wall) return fail("it sent no greeting; check that mural show listens there", true);
    if (wall->version != kWallVersion)
        return fail(fmt::format("it has version {} of the protocol instead of {}; install the same version of mural "
                                "on both machines",
                                wall->version, kWallVersion),
                    true);
    connected.wall = *wall;
    return connected;
}

WallSender::Failure WallSender::serve(Connected& connected) {
    WallLink& link = *connected.link;
    {
        const std::lock_guard lock(mutex_);
        window_ = SendWindow(config_.target.rate);
        want_ = {0, connected.wall.width, connected.wall.height, false};
        transfer_.reset();
        ended_.reset();
        sentFrame_ = sentNumber_ = 0;
        isSending_ = false;
        link_ = &link;
        isConnected_ = true;
        hasShown_ = false;
    }
    std::thread reader([this, &link] { read(link); });
    TileEncoder encoder(config_.target.codec, config_.target.tile);
    std::unique_lock lock(mutex_);
    while (!stop_ && !ended_) {
        const int64_t nowNs = monotonicNowNs();
        if (window_.silentNs(nowNs) > kSilenceNs) {
            ended_ = Failure{"it has shown no picture for 10 s; check that mural show is not stopped", false};
            break;
        }
        const bool hasNew = latest_.picture && latest_.frame > sentFrame_;
        if (!hasNew || !window_.maySend(nowNs)) {
            const int64_t waitNs = hasNew && window_.hasRoom() ? window_.nextNs() - nowNs : INT64_MAX;
            changed_.wait_for(lock, std::min<std::chrono::nanoseconds>(kWorkSlice, std::chrono::nanoseconds(waitNs)));
            continue;
        }
        const Offered offered = latest_;
        sentFrame_ = offered.frame;
        const uint64_t number = ++sentNumber_;
        isSending_ = true;
        limits_ = want_;
        if (std::exchange(want_.isWhole, false)) encoder.restart();
        if (const auto transfer = std::exchange(transfer_, {})) encoder.transferred(transfer->bytes, transfer->ns);
        lock.unlock();
        auto sent = sendFrame(link, encoder, number, offered);
        lock.lock();
        isSending_ = false;
        changed_.notify_all();
        if (!sent && !ended_) ended_ = Failure{sent.error().message, false};
    }
    const Failure failure = ended_.value_or(Failure{"the session ends", true});
    const bool isOwnEnd = stop_ && !ended_;
    isConnected_ = false;
    link_ = nullptr;
    changed_.notify_all();
    lock.unlock();
    if (isOwnEnd) (void)link.send(Bye{failure.reason, false}, Deadline::inMs(kReadSliceMs));
    link.close();
    reader.join();
    return failure;
}

Result<void> WallSender::sendFrame(WallLink& link, TileEncoder& encoder, uint64_t number, const Offered& offered) {
    const int64_t beganNs = monotonicNowNs();
    const uint64_t sentBefore = link.bytesSent();
    const std::vector<Picture> eyes = eyesOf(*offered.picture);
    auto end = encoder.encode(number, eyes, [&](const Tile& tile) {
        return link.send(tile, Deadline::inMs(kWriteMs), WallLink::Follows::More);
    });
    if (!end) return end.error();
    end->wallFrame = offered.frame;
    {
        // Noted first, because the acknowledgement may overtake this thread.
        const std::lock_guard lock(mutex_);
        window_.sent(number, link.bytesSent() - sentBefore, beganNs, monotonicNowNs());
    }
    auto sent = link.send(*end, Deadline::inMs(kWriteMs));
    log::trace(log::Topic::Output, "remote wall ", config_.target.name, ": frame ", offered.frame, ", ", end->tiles,
               " tiles, ", link.bytesSent() - sentBefore, " bytes");
    return sent;
}

std::vector<Picture> WallSender::eyesOf(const OwnedPicture& picture) {
    Picture view = picture.view();
    if (view.format != PictureFormat::Bgra8) {
        eightBits_.resize(view.width, view.height);
        copyInto(eightBits_, 0, 0, view);
        view = eightBits_.view();
    }
    if (!config_.hasPairs) return {reduced(view, reducedEyes_[0])};
    const EyePair pair = eyesOfStack(view);
    return {reduced(pair.left, reducedEyes_[0]), reduced(pair.right, reducedEyes_[1])};
}

Picture WallSender::reduced(const Picture& picture, OwnedPicture& memory) const {
    if (limits_.width == 0 || limits_.height == 0) return picture;
    const ReducedSize size = reducedSize(picture.width, picture.height, limits_.width, limits_.height);
    if (size.width == picture.width && size.height == picture.height) return picture;
    memory.resize(size.width, size.height);
    reducePicture(picture, size, memory.data());
    return memory.view();
}

void WallSender::read(WallLink& link) {
    while (true) {
        auto message = link.receive(Deadline::inMs(kReadSliceMs));
        if (!message) return endReading({message.error().message, false});
        if (!*message) {
            const std::lock_guard lock(mutex_);
            if (!isConnected_) return;
            continue;
        }
        if (const auto* bye = std::get_if<Bye>(&**message)) return endReading({bye->reason, bye->isFinal});
        if (auto taken = take(**message); !taken) return endReading({taken.error().message, false});
    }
}

void WallSender::endReading(Failure failure) {
    const std::lock_guard lock(mutex_);
    if (!ended_) ended_ = std::move(failure);
    changed_.notify_all();
}

Result<void> WallSender::take(const Message& message) {
    if (const auto* event = std::get_if<Event>(&message)) {
        if (config_.onEvent) config_.onEvent(event->input);
        return {};
    }
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
    if (const auto* ack = std::get_if<Ack>(&message)) {
        auto transfer = window_.acknowledge(ack->frame, monotonicNowNs() - static_cast<int64_t>(ack->shownNs));
        if (!transfer) return transfer.error();
        if (*transfer && (*transfer)->bytes >= kMinTransferBytes && (*transfer)->ns > 0) transfer_ = *transfer;
        hasShown_ = true;
        return {};
    }
    if (const auto* want = std::get_if<Want>(&message)) {
        const bool isWhole = want_.isWhole || want->isWhole;
        want_ = *want;
        want_.isWhole = isWhole;
        window_.limitRate(want->rate);
        sentFrame_ = 0; // sends a still picture again
        return {};
    }
    return Error{"it sent a message that only senders send"};
}

} // namespace mural::remote
