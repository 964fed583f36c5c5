#include "transport/fabric/fabric_channel.hpp"

#include <algorithm>

namespace mural::fabric {

namespace {

constexpr unsigned kReading = static_cast<unsigned>(Channel::Side::Reading);
constexpr unsigned kWriting = static_cast<unsigned>(Channel::Side::Writing);
constexpr int64_t kSliceNs = kNsPerS; // of a wait on the condition variable

// Returns true for every error code that reports the peer's end.
bool isEnd(long code) {
    const long positive = code < 0 ? -code : code;
    return positive == FI_ECANCELED || positive == FI_ENOTCONN || positive == FI_ESHUTDOWN;
}

} // namespace

Channel::Channel(std::unique_ptr<Endpoint> endpoint, Greeting peer)
    : endpoint_(std::move(endpoint)),
      messageBytes_(std::min<size_t>(kMessageBytes, peer.messageBytes)),
      window_(peer.window),
      credits_(peer.window) {
    for (size_t i = 0; i < kSends; ++i) freeSends_.push_back(kReceives + i);
}

// Advances the channel and notifies other waiting threads, including the one at the descriptors, for which no further
// event may arrive.
void Channel::progress(Side by) {
    unsigned progress = takeCompletions();
    if (std::exchange(checkEvents_, false) && !gone_ && endpoint_->shutDownMeanwhile()) {
        progress |= takeCompletions(); // data before the end counts
        end(0);
        progress = kReading | kWriting;
    }
    sendControls();
    progress &= ~static_cast<unsigned>(by);
    if (progress & sleeper_) endpoint_->wake();
    if (progress && waiting_ > 0) changed_.notify_all();
}

unsigned Channel::takeCompletions() {
    std::array<Endpoint::Completion, 16> some{};
    unsigned progress = 0;
    while (!gone_) {
        long code = 0;
        const int got = endpoint_->completions(some, code);
        if (got == 0) break;
        if (got < 0) {
            end(code);
            return kReading | kWriting;
        }
        for (const auto& each : std::span(some).first(static_cast<size_t>(got))) progress |= onReceived(each);
    }
    return progress;
}

unsigned Channel::onReceived(const Endpoint::Completion& completion) {
    const Endpoint::Slot slot = completion.slot;
    if (slot >= kReceives) {
        freeSends_.push_back(slot);
        --sendsUnderWay_;
        return kWriting;
    }
    const auto bytes = endpoint_->memory(slot).first(std::min(completion.sizeBytes, kMessageBytes));
    const auto kind = bytes.size() < kHeaderBytes ? MessageKind{} : static_cast<MessageKind>(bytes[0]);
    switch (kind) {
    case MessageKind::Data:
        if (closedHere_)
            receiveInto(slot); // no reader
        else
            received_.push_back({slot, bytes.subspan(kHeaderBytes)});
        return kReading;
    case MessageKind::Credit:
        onCredits(loadLittle<uint16_t>(bytes.data() + 2));
        receiveInto(slot);
        return kWriting;
    case MessageKind::Bye: end(0); break;
    default: end("the peer sent an invalid message; check that Mural listens there");
    }
    return kReading | kWriting;
}

void Channel::onCredits(uint16_t credits) {
    if (credits > window_ - credits_)
        end("the peer granted more credits than it has buffers; check that Mural listens there");
    else
        credits_ = static_cast<uint16_t>(credits_ + credits);
}

void Channel::receiveInto(Endpoint::Slot slot) {
    if (gone_) return;
    if (const long code = endpoint_->receive(slot); code != 0) end(code);
}

// Includes messages that found no room before.
void Channel::sendControls() {
    if (byeSent_) return;
    if (gone_) {
        if (fault_.empty()) byeSent_ = injected(makeHeader(MessageKind::Bye)); // the reply to the peer's Bye
        return;
    }
    if (closedHere_) {
        if (sendGathered()) byeSent_ = injected(makeHeader(MessageKind::Bye));
    } else if (pendingCredits_ >= kCreditsAtOnce && injected(makeHeader(MessageKind::Credit, pendingCredits_))) {
        pendingCredits_ = 0;
    }
}

bool Channel::injected(const Header& header) {
    const long code = endpoint_->inject(header);
    if (code != 0 && code != -FI_EAGAIN && !gone_) end(code);
    return code != -FI_EAGAIN;
}

void Channel::end(std::string fault) {
    if (gone_) return;
    gone_ = true;
    fault_ = std::move(fault);
}

void Channel::end(long code) { end(code == 0 || isEnd(code) ? std::string() : codeText(code)); }

Channel::Message Channel::takeMessage() {
    const Message message = received_.front();
    received_.pop_front();
    return message;
}

void Channel::giveBack(Endpoint::Slot slot) {
    receiveInto(slot);
    ++pendingCredits_;
    sendControls();
}

size_t Channel::gather(std::span<const std::byte> bytes) {
    size_t done = 0;
    while (done < bytes.size() && hasRoom()) {
        if (gathering_ == 0) {
            gathering_ = freeSends_.back();
            freeSends_.pop_back();
            const Header header = makeHeader(MessageKind::Data);
            std::copy(header.begin(), header.end(), endpoint_->memory(gathering_).begin());
            gatheredBytes_ = kHeaderBytes;
        }
        const size_t n = std::min(bytes.size() - done, messageBytes_ - gatheredBytes_);
        std::memcpy(endpoint_->memory(gathering_).data() + gatheredBytes_, bytes.data() + done, n);
        gatheredBytes_ += n;
        done += n;
        if (gatheredBytes_ == messageBytes_) sendGathered();
    }
    return done;
}

bool Channel::hasRoom() {
    if (ended()) return false;
    if (gathering_ != 0 && (gatheredBytes_ < messageBytes_ || !sendGathered())) return gatheredBytes_ < messageBytes_;
    return !freeSends_.empty();
}

bool Channel::sendGathered() {
    if (gathering_ == 0) return true;
    if (credits_ == 0 || gone_) return false;
    const long code = endpoint_->send(gathering_, gatheredBytes_);
    if (code == -FI_EAGAIN) return false;
    if (code != 0) {
        end(code);
        return false;
    }
    --credits_;
    ++sendsUnderWay_;
    gathering_ = 0;
    return true;
}

// A provider may have to wait for room to send, so the thread at the descriptors must poll for that too.
void Channel::sleep(Lock& lock, Side side, Deadline deadline) {
    if (sleeper_ != 0) {
        if (sendsUnderWay_ > 0) endpoint_->wake();
        ++waiting_;
        changed_.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kSliceNs)));
        --waiting_;
        return;
    }
    if (!endpoint_->mayExpectWakeUp()) {
        checkEvents_ = true;
        return;
    }
    sleeper_ = static_cast<unsigned>(side);
    lock.unlock();
    const bool eventsCame = endpoint_->sleep(deadline);
    lock.lock();
    sleeper_ = 0;
    checkEvents_ |= eventsCame;
}

// Another waiting thread takes over the descriptors.
Channel::End Channel::leave(End end) {
    if (waiting_ > 0 && sleeper_ == 0) changed_.notify_all();
    return end;
}

void Channel::close() {
    closedHere_ = true;
    received_.clear(); // the peer gets no more credits for these slots
    wakeAll();
    progress(Side::Writing);
}

bool Channel::finished() { return gone_ && (byeSent_ || !fault_.empty()); }

void Channel::drain(Lock& lock, Deadline deadline, const std::atomic<bool>& stop) {
    while (true) {
        progress(Side::Writing);
        if (finished() || stop || deadline.passed()) break;
        sleep(lock, Side::Writing, deadline);
    }
    endpoint_->shutDown();
    leave(End::Ended);
}

void Channel::wakeAll() {
    if (sleeper_ != 0) endpoint_->wake();
    changed_.notify_all();
}

bool Channel::checkForEnd() {
    checkEvents_ = true;
    progress(Side::Reading);
    return ended();
}

} // namespace mural::fabric
