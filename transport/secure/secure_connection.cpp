#include "transport/secure/secure_connection.hpp"

#include <algorithm>
#include <cstring>

#include "common/log/log.hpp"
#include "transport/connection_error.hpp"
#include "transport/flush_grace.hpp"

namespace mural {

namespace {
// A message fills two TLS records; the underlying connection writes it completely or not at all.
constexpr size_t kRecordBytes = size_t{32} * 1024 - 4;
constexpr int64_t kSliceMs = 100;
constexpr int64_t kRecordMs = 20'000; // timeout of the rest of a record

Deadline sooner(Deadline a, Deadline b) { return a.leftNs() < b.leftNs() ? a : b; }
Deadline later(Deadline a, Deadline b) { return a.leftNs() < b.leftNs() ? b : a; }
} // namespace

SecureConnection::SecureConnection(std::unique_ptr<Connection> over, SecureChannel channel)
    : over_(std::move(over)), channel_(std::move(channel)) {
    gathered_.reserve(kRecordBytes);
}

SecureConnection::~SecureConnection() { SecureConnection::close(); }

Result<std::unique_ptr<SecureConnection>> SecureConnection::connecting(std::unique_ptr<Connection> over,
                                                                       const std::string& name,
                                                                       const ChannelSecret& secret, Deadline deadline) {
    std::unique_ptr<SecureConnection> c(new SecureConnection(std::move(over), SecureChannel::connecting(name, secret)));
    return shakeHands(std::move(c), deadline, {});
}

Result<std::unique_ptr<SecureConnection>> SecureConnection::accepting(std::unique_ptr<Connection> over,
                                                                      SecureChannel::FindSecret find, Deadline deadline,
                                                                      const Cancelled& cancelled) {
    std::unique_ptr<SecureConnection> c(
        new SecureConnection(std::move(over), SecureChannel::accepting(std::move(find))));
    return shakeHands(std::move(c), deadline, cancelled);
}

Result<std::unique_ptr<SecureConnection>> SecureConnection::shakeHands(std::unique_ptr<SecureConnection> connection,
                                                                       Deadline deadline, const Cancelled& cancelled) {
    SecureConnection& c = *connection;
    while (true) {
        const auto output = c.channel_.takeOutput();
        if (!output.empty()) {
            if (auto sent = c.over_->write(output, deadline); !sent) return sent.error();
            c.over_->flush();
        }
        if (c.channel_.open()) {
            log::debug(log::Topic::Transport, c.over_->describe(), ": encrypted, for \"", c.name(), "\"");
            return connection;
        }
        c.arrived_.resize(c.channel_.wantsBytes());
        const auto got = c.over_->read(c.arrived_, sooner(deadline, Deadline::inMs(kSliceMs)));
        if (!got && !c.over_->timedOut()) return got.error();
        if (!got && deadline.passed()) return Error{c.over_->describe() + ": the peer did not authenticate in time"};
        if (!got && cancelled && cancelled())
            return Error{c.over_->describe() + ": the connection is not needed any more"};
        if (!got) continue;
        if (auto good = c.channel_.input(c.arrived_, c.messages_); !good) {
            // The alert tells the peer why the connection ends.
            if (const auto alert = c.channel_.takeOutput(); !alert.empty() && c.over_->write(alert, deadline))
                c.over_->flush();
            return Error{c.over_->describe() + ": " + good.error().message};
        }
    }
}

Result<void> SecureConnection::read(std::span<std::byte> into, Deadline deadline) {
    readTimedOut_ = false;
    size_t done = 0;
    const auto failed = [&](const std::string& why) {
        return connectionError(describe(), "read", done, into.size(), why);
    };
    while (true) {
        const size_t n = std::min(into.size() - done, opened_.size() - openedAt_);
        if (n > 0) std::memcpy(into.data() + done, opened_.data() + openedAt_, n);
        openedAt_ += n;
        done += n;
        if (done == into.size()) break;
        if (closed_) return failed(ending::kClosedHere);
        const auto got = takeRecord(deadline);
        if (got) continue;
        if (!deadline.passed() || !over_->timedOut())
            return closed_ && !channel_.finished() ? failed(ending::kClosedHere) : failed(got.error().message);
        readTimedOut_ = done == 0;
        if (done > 0) endStream();
        return failed(done > 0 ? ending::kCutInHalf : ending::kIdle);
    }
    bytesRead_ += done;
    return {};
}

// Waits for the rest of a record that began before the deadline.
Result<void> SecureConnection::takeRecord(Deadline deadline) {
    messages_.clear();
    Deadline until = deadline;
    while (messages_.empty()) {
        arrived_.resize(channel_.wantsBytes());
        const auto got = over_->read(arrived_, until);
        if (!got) return over_->timedOut() ? got.error() : Error{ending::kPeerGone};
        until = later(deadline, Deadline::inMs(kRecordMs));
        if (auto good = channel_.input(arrived_, messages_); !good) {
            endStream();
            return good.error();
        }
        if (channel_.finished()) {
            endStream();
            return Error{ending::kPeerGone};
        }
    }
    opened_ = std::move(messages_.front());
    openedAt_ = 0;
    return {};
}

Result<void> SecureConnection::write(std::span<const std::byte> bytes, Deadline deadline) {
    writeTimedOut_ = false;
    const std::lock_guard lock(writeMutex_);
    lastWriteDeadline_ = deadline;
    size_t done = 0;
    const auto failed = [&](const std::string& why) {
        return connectionError(describe(), "write", done, bytes.size(), why);
    };
    while (done < bytes.size()) {
        if (closed_) return failed(ending::kClosedHere);
        if (gathered_.size() == kRecordBytes) {
            const auto sent = sendGathered(deadline);
            if (!sent && closed_) return failed(ending::kClosedHere);
            const bool idle = !sent && deadline.passed() && over_->timedOut();
            writeTimedOut_ = idle && done == 0;
            if (!sent && !writeTimedOut_) endStream();
            if (!sent) return failed(writeTimedOut_ ? ending::kIdle : idle ? ending::kCutInHalf : ending::kPeerGone);
        }
        const auto part = bytes.subspan(done, std::min(bytes.size() - done, kRecordBytes - gathered_.size()));
        gathered_.insert(gathered_.end(), part.begin(), part.end());
        done += part.size();
    }
    bytesWritten_ += done;
    return {};
}

// A sealed record cannot be withdrawn: the remainder is sent first next time.
Result<void> SecureConnection::sendGathered(Deadline deadline) {
    while (!sealed_.empty() || !gathered_.empty()) {
        if (sealed_.empty()) {
            if (auto good = channel_.send(gathered_); !good) return good.error();
            gathered_.clear();
            sealed_ = channel_.takeOutput();
        }
        if (auto sent = over_->write(sealed_, deadline); !sent) return sent.error();
        sealed_.clear();
    }
    return {};
}

void SecureConnection::flush() {
    const std::lock_guard lock(writeMutex_);
    if (closed_) return;
    // the next write reports the error
    static_cast<void>(sendGathered(later(lastWriteDeadline_, Deadline::inMs(kFlushGraceMs))).ok());
    over_->flush();
}

void SecureConnection::close() {
    if (const std::unique_lock lock(writeMutex_, std::try_to_lock); lock.owns_lock() && !closed_) {
        if (sendGathered(Deadline::inMs(0))) {
            channel_.finish();
            if (const auto last = channel_.takeOutput(); !last.empty())
                static_cast<void>(over_->write(last, Deadline::inMs(0)).ok());
        }
    }
    endStream();
}

void SecureConnection::endStream() {
    closed_ = true;
    over_->close();
}

} // namespace mural
