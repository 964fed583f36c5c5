#include "transport/fabric/fabric_connection.hpp"

#include <algorithm>
#include <unistd.h>

#include "transport/connection_error.hpp"
#include "transport/fabric/fabric_closing.hpp"

namespace mural::fabric {

namespace {

constexpr int64_t kFlushGraceMs = 1000; // minimum time for a flush long after the last write

using Side = Channel::Side;
using End = Channel::End;

} // namespace

FabricConnection::FabricConnection(std::unique_ptr<Endpoint> endpoint, Greeting peer, std::string description)
    : channel_(std::make_shared<Channel>(std::move(endpoint), peer)),
      description_(std::move(description)),
      ownerPid_(getpid()) {}

// A forked child has a copy of this object. The card's resources belong to the parent and are left alone.
FabricConnection::~FabricConnection() {
    FabricConnection::close();
    if (getpid() != ownerPid_) new std::shared_ptr<Channel>(std::move(channel_));
}

void FabricConnection::close() {
    if (getpid() != ownerPid_) return;
    auto lock = channel_->lock();
    endStream(lock);
}

void FabricConnection::endStream(Channel::Lock& lock) {
    if (closed_.exchange(true)) return;
    channel_->close();
    lock.unlock();
    drainInBackground(channel_);
    lock.lock();
}

size_t FabricConnection::takeBuffered(std::span<std::byte> into) {
    const size_t n = std::min(into.size(), message_.bytes.size());
    if (n == 0) return 0;
    std::memcpy(into.data(), message_.bytes.data(), n);
    message_.bytes = message_.bytes.subspan(n);
    return n;
}

Result<void> FabricConnection::read(std::span<std::byte> into, Deadline deadline) {
    readTimedOut_.store(false, std::memory_order_relaxed);
    size_t done = closed_.load(std::memory_order_relaxed) ? 0 : takeBuffered(into);
    if (done == into.size() && !closed_.load(std::memory_order_relaxed)) {
        bytesRead_.fetch_add(done, std::memory_order_relaxed);
        return {};
    }
    auto lock = channel_->lock();
    while (true) {
        if (std::exchange(reading_, false)) channel_->giveBack(message_.slot);
        const End end =
            closed_ ? End::Ended
                    : channel_->waitUntil(lock, Side::Reading, deadline, [&] { return channel_->hasMessage(); });
        if (end != End::Ready) {
            bytesRead_.fetch_add(done, std::memory_order_relaxed);
            if (end == End::DeadlinePassed && done == 0) readTimedOut_.store(true);
            return failed(lock, "read", end, done, into.size());
        }
        message_ = channel_->takeMessage();
        reading_ = true;
        lock.unlock(); // the message is owned here, so a writer can proceed
        done += takeBuffered(into.subspan(done));
        if (done == into.size()) break;
        lock.lock();
    }
    bytesRead_.fetch_add(done, std::memory_order_relaxed);
    return {};
}

Result<void> FabricConnection::write(std::span<const std::byte> bytes, Deadline deadline) {
    writeTimedOut_.store(false, std::memory_order_relaxed);
    auto lock = channel_->lock();
    lastWriteDeadline_ = deadline;
    if (channel_->ended()) return failed(lock, "write", End::Ended, 0, bytes.size());
    size_t done = 0;
    while ((done += channel_->gather(bytes.subspan(done))) < bytes.size()) {
        const End end = channel_->waitUntil(lock, Side::Writing, deadline, [&] { return channel_->hasRoom(); });
        if (end == End::Ready) continue;
        if (end == End::DeadlinePassed && done == 0) writeTimedOut_.store(true);
        return failed(lock, "write", end, done, bytes.size());
    }
    bytesWritten_.fetch_add(done, std::memory_order_relaxed);
    return {};
}

void FabricConnection::flush() {
    auto lock = channel_->lock();
    if (channel_->ended() || (channel_->sendGathered() && channel_->allSent())) return;
    const bool longer = lastWriteDeadline_.leftNs() > kFlushGraceMs * kNsPerMs;
    const End end =
        channel_->waitUntil(lock, Side::Writing, longer ? lastWriteDeadline_ : Deadline::inMs(kFlushGraceMs),
                            [&] { return channel_->sendGathered() && channel_->allSent(); });
    if (end == End::DeadlinePassed) writeTimedOut_.store(true);
}

bool FabricConnection::timedOut() const { return !closed_ && (readTimedOut_ || writeTimedOut_); }

bool FabricConnection::alive() const {
    if (closed_) return false;
    const auto lock = channel_->lock();
    return !channel_->checkForEnd();
}

// A partially transferred message cannot be repaired: the connection ends, which informs the peer.
Error FabricConnection::failed(Channel::Lock& lock, const char* verb, End end, size_t doneBytes, size_t wantedBytes) {
    const bool here = closed_;
    const bool cutInHalf = end == End::DeadlinePassed && doneBytes > 0;
    if (cutInHalf) endStream(lock);
    std::string reason = ending::kPeerGone;
    if (here)
        reason = ending::kClosedHere;
    else if (end == End::DeadlinePassed)
        reason = cutInHalf ? ending::kCutInHalf : ending::kIdle;
    else if (!channel_->fault().empty())
        reason += " (" + channel_->fault() + ")";
    return connectionError(description_, verb, doneBytes, wantedBytes, reason);
}

} // namespace mural::fabric
