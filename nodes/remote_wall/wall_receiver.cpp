#include "nodes/remote_wall/wall_receiver.hpp"

#include <algorithm>
#include <chrono>
#include <poll.h>
#include <utility>

#include <fmt/format.h>

#include "common/log/log.hpp"
#include "transport/secure/secure_connection.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural::remote {

namespace {

constexpr int64_t kAcceptSlice = 200, kSecretMs = 5'000, kHelloMs = 5'000;
constexpr int64_t kReceiveSliceMs = 200;
constexpr int64_t kReplyMs = 2'000; // a sender that reads nothing is gone
constexpr int64_t kRefusalEveryNs = kNsPerS;
constexpr std::chrono::milliseconds kNextSlice{250};

} // namespace

Result<std::unique_ptr<WallReceiver>> WallReceiver::open(WallReceiverConfig config) {
    auto listener = listenTcp(config.host, config.port);
    if (!listener) return listener.error();
    return std::unique_ptr<WallReceiver>(new WallReceiver(std::move(config), std::move(*listener)));
}

WallReceiver::WallReceiver(WallReceiverConfig config, std::unique_ptr<Listener> listener)
    : config_(std::move(config)), listener_(std::move(listener)), accepting_([this] { acceptAll(); }) {}

WallReceiver::~WallReceiver() { end("mural show ends"); }

void WallReceiver::end(const std::string& reason) {
    if (stop_.exchange(true)) return;
    sendToAll(Bye{reason, false});
    if (accepting_.joinable()) accepting_.join();
}

void WallReceiver::acceptAll() {
    while (!stop_) {
        std::erase_if(visits_, [](Visit& visit) {
            if (!visit.isOver) return false;
            visit.thread.join();
            return true;
        });
        const int64_t beganNs = monotonicNowNs();
        auto connection = listener_->accept(Deadline::inMs(kAcceptSlice));
        if (!connection) {
            // Out of descriptors: avoids a busy loop.
            if (monotonicNowNs() - beganNs < kAcceptSlice * kNsPerMs / 2)
                poll(nullptr, 0, static_cast<int>(kAcceptSlice));
            continue;
        }
        if (visits_.size() >= kMaxConnections) continue; // destroys the connection
        Visit& visit = visits_.emplace_back();
        visit.thread = std::thread([this, &visit, c = std::move(*connection)]() mutable {
            serve(std::move(c));
            visit.isOver = true;
        });
    }
    for (Visit& visit : visits_) visit.thread.join();
}

// Bounds the lines that a stranger can cause.
void WallReceiver::refuse(const std::string& why) {
    {
        const std::lock_guard lock(mutex_);
        const int64_t nowNs = monotonicNowNs();
        if (refusedNs_ != 0 && nowNs - refusedNs_ < kRefusalEveryNs) return;
        refusedNs_ = nowNs;
    }
    log::warning(log::Topic::Output, "a sender was not accepted: ", why);
}

void WallReceiver::serve(std::unique_ptr<Connection> connection) {
    const std::string peer = connection->describe();
    auto secure = SecureConnection::accepting(
        std::move(connection), [this](const std::string&) { return std::optional(config_.secret); },
        Deadline::inMs(kSecretMs), [this] { return stop_.load(); });
    if (!secure) return refuse(secure.error().message);
    const auto link = std::make_shared<WallLink>(std::move(*secure));
    auto first = link->receive(Deadline::inMs(kHelloMs));
    if (!first) return refuse(first.error().message);
    const Hello* const hello = *first ? std::get_if<Hello>(&**first) : nullptr;
    if (!hello) return refuse(peer + ": it sent no greeting; check that it is mural run --send");
    if (stop_) return;
    auto objection = objectionTo(*hello);
    if (!objection) objection = join(*hello, link);
    if (objection) {
        (void)link->send(*objection, Deadline::inMs(kReplyMs));
        return refuse(peer + ": " + objection->reason);
    }
    log::info(log::Topic::Output, "\"", hello->name, "\" sends its pictures from ", peer);
    const Hello accepted = *hello;
    const auto read = readFrom(accepted, link);
    leave(accepted, link);
    if (!stop_)
        log::info(log::Topic::Output, "\"", accepted.name, "\" at ", peer, " is gone: ", read.error().message,
                  "; its last picture stays");
}

std::optional<Bye> WallReceiver::objectionTo(const Hello& hello) const {
    if (hello.version != kWallVersion)
        return Bye{fmt::format("{} has version {} of the protocol, the sender has {}; install the same version of "
                               "mural on both machines",
                               config_.name, kWallVersion, hello.version),
                   true};
    if (const auto known = wantedCodec(hello.codec); !known)
        return Bye{config_.name + " has no such codec: " + known.error().message, true};
    return std::nullopt;
}

std::optional<Bye> WallReceiver::join(const Hello& hello, const std::shared_ptr<WallLink>& link) {
    bool hasOthers = false;
    {
        const std::lock_guard lock(mutex_);
        const bool isKnown = sender_ && sender_->hello.session == hello.session;
        if (sender_ && !sender_->links.empty() && !isKnown)
            return Bye{"it shows the pictures of \"" + sender_->hello.name +
                           "\"; end that session, or use another port",
                       false};
        auto links = isKnown ? std::exchange(sender_->links, {}) : std::map<uint32_t, std::shared_ptr<WallLink>>();
        if (const auto before = links.find(hello.source); before != links.end()) {
            before->second->close();
            links.erase(before);
        }
        hasOthers = !links.empty();
        sender_.emplace(hello);
        sender_->links = std::move(links);
        sender_->links[hello.source] = link;
        ++epoch_;
        hasNewest_ = false;
    }
    Hello own;
    own.name = config_.name;
    own.codec = hello.codec;
    own.session = hello.session;
    own.width = config_.limits.width;
    own.height = config_.limits.height;
    (void)link->send(own, Deadline::inMs(kReplyMs)); // the reader detects the end of the connection
    Want want = config_.limits;
    want.isWhole = hasOthers;
    if (hasOthers)
        sendToAll(want);
    else if (want.rate > 0)
        (void)link->send(want, Deadline::inMs(kReplyMs));
    return std::nullopt;
}

Result<void> WallReceiver::readFrom(const Hello& hello, const std::shared_ptr<WallLink>& link) {
    while (!stop_) {
        auto message = link->receive(Deadline::inMs(kReceiveSliceMs));
        if (!message) return message.error();
        if (!*message) continue;
        if (const auto* bye = std::get_if<Bye>(&**message)) return Error{bye->reason};
        if (auto taken = take(hello, link, **message); !taken) {
            (void)link->send(Bye{taken.error().message, false}, Deadline::inMs(kReplyMs));
            return taken;
        }
    }
    return Error{"mural show ends"};
}

Result<void> WallReceiver::take(const Hello& hello, const std::shared_ptr<WallLink>& link, const Message& message) {
    bool hasLoss = false;
    {
        const std::lock_guard lock(mutex_);
        const auto own = sender_ ? sender_->links.find(hello.source) : decltype(sender_->links.end())();
        if (!sender_ || own == sender_->links.end() || own->second != link)
            return Error{"another connection replaces this one"};
        FrameAssembly& assembly = sender_->assembly;
        if (const auto* tile = std::get_if<Tile>(&message)) return assembly.add(hello.source, *tile);
        const auto* end = std::get_if<FrameEnd>(&message);
        if (!end) return Error{"it sent a message that only remote walls send"};
        if (auto ended = assembly.end(hello.source, *end); !ended) return ended;
        if (auto complete = showComplete(); !complete) return complete;
        hasLoss = assembly.takeLoss();
    }
    if (hasLoss) {
        Want want = config_.limits;
        want.isWhole = true;
        sendToAll(want);
    }
    return {};
}

Result<void> WallReceiver::showComplete() {
    const std::vector<CompleteFrame> frames = sender_->assembly.takeComplete();
    for (const CompleteFrame& frame : frames)
        if (auto applied = sender_->canvas.apply(frame); !applied) return applied;
    if (frames.empty()) return {};
    newest_.number = frames.back().number;
    newest_.wallFrame = frames.back().wallFrame;
    newest_.session = sender_->hello.session;
    newest_.epoch = epoch_;
    newest_.eyes = frames.back().size.eyes;
    newest_.completeNs = monotonicNowNs();
    hasNewest_ = true;
    for (int eye = 0; eye < newest_.eyes; ++eye)
        newest_.pictures[static_cast<size_t>(eye)].assign(sender_->canvas.picture(eye));
    changed_.notify_all();
    return {};
}

void WallReceiver::leave(const Hello& hello, const std::shared_ptr<WallLink>& link) {
    const std::lock_guard lock(mutex_);
    if (!sender_) return;
    const auto own = sender_->links.find(hello.source);
    if (own != sender_->links.end() && own->second == link) sender_->links.erase(own);
}

void WallReceiver::sendToAll(const Message& message) {
    std::vector<std::shared_ptr<WallLink>> links;
    {
        const std::lock_guard lock(mutex_);
        if (!sender_) return;
        for (const auto& [source, link] : sender_->links) links.push_back(link);
    }
    for (const auto& link : links)
        if (!link->send(message, Deadline::inMs(kReplyMs))) link->close();
}

void WallReceiver::sendEvent(const input::InputEvent& event) {
    const std::lock_guard lock(mutex_);
    if (!sender_ || sender_->links.empty()) return;
    // Of moves only the latest matters.
    const bool isMove = event.kind == input::InputKind::Move;
    if (isMove && !events_.empty() && events_.back().kind == input::InputKind::Move) events_.pop_back();
    if (events_.size() >= kMaxEvents) return;
    events_.push_back(event);
    changed_.notify_all();
}

void WallReceiver::sendEvents() {
    std::deque<input::InputEvent> events;
    std::shared_ptr<WallLink> first; // the sender takes events from one source
    {
        const std::lock_guard lock(mutex_);
        std::swap(events, events_);
        if (sender_ && !sender_->links.empty()) first = sender_->links.begin()->second;
    }
    for (const input::InputEvent& event : events)
        if (first && !first->send(Event{event}, Deadline::inMs(kReplyMs))) first->close();
}

bool WallReceiver::next(ReceivedFrame& into, Deadline deadline) {
    while (true) {
        sendEvents();
        std::unique_lock lock(mutex_);
        const auto wait = std::min<std::chrono::nanoseconds>(kNextSlice, std::chrono::nanoseconds(deadline.leftNs()));
        changed_.wait_for(lock, wait, [this] { return hasNewest_ || !events_.empty(); });
        if (hasNewest_) {
            std::swap(into, newest_);
            hasNewest_ = false;
            return true;
        }
        if (events_.empty() && deadline.passed()) return false;
    }
}

void WallReceiver::shown(const ReceivedFrame& frame) {
    {
        const std::lock_guard lock(mutex_);
        if (frame.epoch != epoch_) return;
    }
    const int64_t tookNs = monotonicNowNs() - frame.completeNs;
    sendToAll(Ack{frame.number, static_cast<uint64_t>(std::max<int64_t>(tookNs, 0))});
}

} // namespace mural::remote
