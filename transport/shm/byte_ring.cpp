#include "transport/shm/byte_ring.hpp"

#include <algorithm>
#include <cstring>

#include "common/ipc/futex.hpp"
#include "transport/shm/streaming_copy.hpp"

namespace mural {

namespace {

// Size of a published piece: small enough that one side writes a piece while the other reads the previous one.
uint32_t pieceFor(size_t capacityBytes) {
    return static_cast<uint32_t>(std::clamp<size_t>(capacityBytes / 8, 16, size_t{64} * 1024));
}

// The reader is woken early, because it can draw the data that is already there. The writer is woken late: a full ring
// means that it is ahead, and small steps would only cost wake-ups.
uint32_t announceDataFor(size_t capacityBytes) {
    return static_cast<uint32_t>(std::clamp<size_t>(capacityBytes / 8, 1, size_t{64} * 1024));
}

uint32_t announceRoomFor(size_t capacityBytes) { return static_cast<uint32_t>(std::max<size_t>(capacityBytes / 4, 1)); }

// Publishes a position, and wakes the other side if it sleeps. The waker stores the position and then loads the flag;
// sleepWhileEqual() stores the flag and then loads the position. Both are sequentially consistent, so the sleeper sees
// the new position, or the waker sees the flag. The exchange limits this to one wake-up per sleep.
bool wakeIfWaiting(std::atomic<uint32_t>& waiting, std::atomic<uint32_t>& position, uint32_t positionNow) {
    position.store(positionNow, std::memory_order_seq_cst);
    if (waiting.load(std::memory_order_seq_cst) == 0) return false;
    if (waiting.exchange(0, std::memory_order_seq_cst) == 0) return false;
    futexWakeAll(position);
    return true;
}

void sleepWhileEqual(std::atomic<uint32_t>& waiting, const std::atomic<uint32_t>& position, uint32_t unchanged,
                     int64_t timeoutNs) {
    waiting.store(1, std::memory_order_seq_cst);
    if (position.load(std::memory_order_seq_cst) == unchanged) {
        futexWait(position, unchanged, timeoutNs);
    }
    waiting.store(0, std::memory_order_relaxed);
}

} // namespace

void wakeRing(RingControl& control) {
    futexWakeAll(control.tail);
    futexWakeAll(control.head);
}

RingWriter::RingWriter(RingControl& control, std::byte* data, size_t capacityBytes)
    : control_(control),
      data_(data),
      capacityBytes_(static_cast<uint32_t>(capacityBytes)),
      pieceBytes_(pieceFor(capacityBytes)),
      announceBytes_(announceDataFor(capacityBytes)) {}

// Loads the reader's position only if the cached value is insufficient, so its cache line stays with the reader.
size_t RingWriter::room(size_t wantedBytes) {
    uint32_t freeBytes = capacityBytes_ - (tail_ - seenHead_);
    if (freeBytes >= wantedBytes) return freeBytes;
    const uint32_t head = control_.head.load(std::memory_order_acquire);
    if (tail_ - head > capacityBytes_) {
        damaged_ = true;
        return 0;
    }
    seenHead_ = head;
    freeBytes = capacityBytes_ - (tail_ - head);
    return freeBytes;
}

void RingWriter::copyIn(std::span<const std::byte> bytes) {
    const uint32_t at = tail_ & (capacityBytes_ - 1);
    const size_t first = std::min<size_t>(bytes.size(), capacityBytes_ - at);
    streamingCopy(data_ + at, bytes.data(), first);
    if (first < bytes.size()) streamingCopy(data_, bytes.data() + first, bytes.size() - first);
}

size_t RingWriter::write(std::span<const std::byte> bytes) {
    size_t done = 0;
    while (done < bytes.size() && !damaged_) {
        const size_t wanted = std::min<size_t>(bytes.size() - done, pieceBytes_);
        const size_t n = std::min(wanted, room(wanted));
        if (n == 0) break;
        copyIn(bytes.subspan(done, n));
        tail_ += static_cast<uint32_t>(n);
        control_.tail.store(tail_, std::memory_order_release);
        done += n;
        unannouncedBytes_ += static_cast<uint32_t>(n);
        if (unannouncedBytes_ >= announceBytes_) announce();
    }
    return done;
}

void RingWriter::announce() {
    unannouncedBytes_ = 0;
    if (wakeIfWaiting(control_.readerWaiting, control_.tail, tail_)) ++wakeUps_;
}

void RingWriter::sleepUntilRoom(int64_t timeoutNs) {
    if (unannouncedBytes_ != 0) announce();
    sleepWhileEqual(control_.writerWaiting, control_.head, tail_ - capacityBytes_, timeoutNs);
}

RingReader::RingReader(RingControl& control, const std::byte* data, size_t capacityBytes)
    : control_(control),
      data_(data),
      capacityBytes_(static_cast<uint32_t>(capacityBytes)),
      pieceBytes_(pieceFor(capacityBytes)),
      announceBytes_(announceRoomFor(capacityBytes)) {}

size_t RingReader::available(size_t wantedBytes) {
    if (seenTail_ - head_ >= wantedBytes) return seenTail_ - head_;
    const uint32_t tail = control_.tail.load(std::memory_order_acquire);
    if (tail - head_ > capacityBytes_) {
        damaged_ = true;
        return 0;
    }
    seenTail_ = tail;
    return tail - head_;
}

void RingReader::copyOut(std::span<std::byte> into) const {
    const uint32_t at = head_ & (capacityBytes_ - 1);
    const size_t first = std::min<size_t>(into.size(), capacityBytes_ - at);
    std::memcpy(into.data(), data_ + at, first);
    if (first < into.size()) std::memcpy(into.data() + first, data_, into.size() - first);
}

size_t RingReader::read(std::span<std::byte> into) {
    size_t done = 0;
    while (done < into.size() && !damaged_) {
        const size_t wanted = std::min<size_t>(into.size() - done, pieceBytes_);
        const size_t n = std::min(wanted, available(wanted));
        if (n == 0) break;
        copyOut(into.subspan(done, n));
        head_ += static_cast<uint32_t>(n);
        control_.head.store(head_, std::memory_order_release);
        done += n;
        unannouncedBytes_ += static_cast<uint32_t>(n);
        if (unannouncedBytes_ >= announceBytes_) announce();
    }
    return done;
}

void RingReader::announce() {
    unannouncedBytes_ = 0;
    if (wakeIfWaiting(control_.writerWaiting, control_.head, head_)) ++wakeUps_;
}

void RingReader::sleepUntilData(int64_t timeoutNs) {
    if (unannouncedBytes_ != 0) announce();
    sleepWhileEqual(control_.readerWaiting, control_.tail, head_, timeoutNs);
}

} // namespace mural
