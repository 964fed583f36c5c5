#include "transport/shm/ring_connection.hpp"

#include "transport/connection_error.hpp"

#include <algorithm>
#include <poll.h>
#include <unistd.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace mural {

namespace {

// Interval of liveness checks by a blocked side: less than half of the 50 ms within which a death must be noticed.
constexpr int64_t kSliceNs = 20 * kNsPerMs;

// Spinning for a few microseconds costs less than a sleep and its wake-up. Unsuccessful spinning takes CPU time from
// others, perhaps from the peer, so each failure halves the next attempt and a success restores it.
constexpr int kMaxSpins = 100;
constexpr int kMinSpins = 2;

template <class Ready> bool spinUntil(Ready ready, int& spins) {
    for (int i = 0; i < spins; ++i) {
        if (ready()) {
            spins = kMaxSpins;
            return true;
        }
#if defined(__SSE2__)
        _mm_pause();
#endif
    }
    spins = std::max(spins / 2, kMinSpins);
    return false;
}

} // namespace

RingConnection::RingConnection(std::shared_ptr<RingMemory> memory, int side, FileDescriptor peerSocket,
                               std::string description)
    : memory_(std::move(memory)),
      outControl_(memory_->control(side)),
      inControl_(memory_->control(1 - side)),
      writer_(outControl_, memory_->data(side), memory_->capacityBytes()),
      reader_(inControl_, memory_->data(1 - side), memory_->capacityBytes()),
      peerSocket_(std::move(peerSocket)),
      description_(std::move(description)),
      ownerPid_(getpid()) {}

RingConnection::~RingConnection() { RingConnection::close(); }

// A forked child has a copy of this object, whose destruction must not end the parent's connection.
void RingConnection::close() {
    if (closed_.exchange(true) || getpid() != ownerPid_) return;
    outControl_.writerClosed.store(1, std::memory_order_release);
    inControl_.readerClosed.store(1, std::memory_order_release);
    wakeRing(outControl_);
    wakeRing(inControl_);
}

Result<void> RingConnection::read(std::span<std::byte> into, Deadline deadline) {
    readTimedOut_.store(false, std::memory_order_relaxed);
    if (closed_.load(std::memory_order_relaxed)) return failed("read", WaitEnd::ClosedHere, 0, into.size());
    size_t done = 0;
    while (true) {
        const size_t n = reader_.read(into.subspan(done));
        done += n;
        bytesRead_.fetch_add(n, std::memory_order_relaxed);
        if (done == into.size()) return {};
        const WaitEnd end = waitForData(deadline);
        if (end == WaitEnd::Ready) continue;
        if (end == WaitEnd::DeadlinePassed && done == 0) readTimedOut_.store(true);
        return failed("read", end, done, into.size());
    }
}

Result<void> RingConnection::write(std::span<const std::byte> bytes, Deadline deadline) {
    writeTimedOut_.store(false, std::memory_order_relaxed);
    if (closed_.load(std::memory_order_relaxed)) return failed("write", WaitEnd::ClosedHere, 0, bytes.size());
    size_t done = 0;
    while (outControl_.readerClosed.load(std::memory_order_relaxed) == 0) {
        const size_t n = writer_.write(bytes.subspan(done));
        done += n;
        bytesWritten_.fetch_add(n, std::memory_order_relaxed);
        if (done == bytes.size()) return {};
        const WaitEnd end = waitForRoom(deadline);
        if (end == WaitEnd::Ready) continue;
        if (end == WaitEnd::DeadlinePassed && done == 0) writeTimedOut_.store(true);
        return failed("write", end, done, bytes.size());
    }
    return failed("write", WaitEnd::PeerGone, done, bytes.size());
}

// Checks the peer before the deadline, so a caller that polls with short deadlines notices the peer's death too.
RingConnection::WaitEnd RingConnection::waitForData(Deadline deadline) {
    if (spinUntil([this] { return reader_.hasData(); }, readSpins_)) return WaitEnd::Ready;
    for (bool slept = false;; slept = true) {
        if (reader_.hasData()) return WaitEnd::Ready;
        if (reader_.damaged()) return WaitEnd::Damaged;
        if (closed_.load(std::memory_order_relaxed)) return WaitEnd::ClosedHere;
        const int64_t leftNs = deadline.leftNs(kSliceNs);
        if (inControl_.writerClosed.load(std::memory_order_acquire) != 0 ||
            ((slept || leftNs == 0) && peerProcessGone())) {
            // Data written before the peer's end can still be read.
            return reader_.hasData() ? WaitEnd::Ready : WaitEnd::PeerGone;
        }
        if (leftNs == 0) return WaitEnd::DeadlinePassed;
        reader_.sleepUntilData(leftNs);
    }
}

RingConnection::WaitEnd RingConnection::waitForRoom(Deadline deadline) {
    if (spinUntil([this] { return writer_.hasRoom(); }, writeSpins_)) return WaitEnd::Ready;
    for (bool slept = false;; slept = true) {
        if (outControl_.readerClosed.load(std::memory_order_acquire) != 0) return WaitEnd::PeerGone;
        if (closed_.load(std::memory_order_relaxed)) return WaitEnd::ClosedHere;
        if (writer_.hasRoom()) return WaitEnd::Ready;
        if (writer_.damaged()) return WaitEnd::Damaged;
        const int64_t leftNs = deadline.leftNs(kSliceNs);
        if ((slept || leftNs == 0) && peerProcessGone()) return WaitEnd::PeerGone;
        if (leftNs == 0) return WaitEnd::DeadlinePassed;
        writer_.sleepUntilRoom(leftNs);
    }
}

bool RingConnection::peerProcessGone() const {
    if (!peerSocket_.valid()) return false;
    pollfd poller{peerSocket_.get(), POLLRDHUP, 0};
    return poll(&poller, 1, 0) > 0 && (poller.revents & (POLLRDHUP | POLLHUP | POLLERR | POLLNVAL)) != 0;
}

bool RingConnection::timedOut() const { return !closed_ && (readTimedOut_ || writeTimedOut_); }

bool RingConnection::alive() const {
    return !closed_ && inControl_.writerClosed.load(std::memory_order_acquire) == 0 && !peerProcessGone();
}

// A partially transferred message cannot be repaired: the connection ends, which informs the peer. The peer's end alone
// does not close it, because the other direction may still hold data.
Error RingConnection::failed(const char* verb, WaitEnd why, size_t doneBytes, size_t wantedBytes) {
    const bool usable = why == WaitEnd::PeerGone || (why == WaitEnd::DeadlinePassed && doneBytes == 0);
    if (!usable) close();
    const char* reason = ending::kPeerGone;
    if (why == WaitEnd::ClosedHere) reason = ending::kClosedHere;
    if (why == WaitEnd::Damaged) reason = "the peer process has damaged the shared memory; end it";
    if (why == WaitEnd::DeadlinePassed) reason = usable ? ending::kIdle : ending::kCutInHalf;
    return connectionError(description_, verb, doneBytes, wantedBytes, reason);
}

} // namespace mural
