// A ring of bytes with one writer and one reader, in memory that two threads or two processes
// share.
//
// Positions are free-running 32-bit byte counts (capacity ≤ 1 GiB, so differences are unambiguous);
// they are futex words too: the reader sleeps on `tail`, the writer on `head`. A side that sleeps
// says so in its waiting flag; so a stream that flows costs no system call. Wake-ups are batched:
// after announceBytes, at announce(), and before a side goes to sleep itself. Whoever sleeps must
// do it in slices: the last bytes of a batch are visible at once, but only announce() wakes for
// them.
//
// Each side keeps its own position privately: a damaged or hostile peer can't make it run outside
// of the ring (damaged() becomes true instead).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mural {

constexpr size_t kMinRingBytes = 64;
constexpr size_t kMaxRingBytes = size_t{1} << 30;

// Lives in the shared memory; zero bytes are its valid first state.
struct RingControl {
    alignas(64) std::atomic<uint32_t> tail; // bytes written so far
    alignas(64) std::atomic<uint32_t> head; // bytes read so far
    alignas(64) std::atomic<uint32_t> readerWaiting;
    alignas(64) std::atomic<uint32_t> writerWaiting;
    alignas(64) std::atomic<uint32_t> writerClosed; // no more bytes will come
    std::atomic<uint32_t> readerClosed;             // no more bytes will be read
};
static_assert(std::atomic<uint32_t>::is_always_lock_free, "needed between processes");

// Wakes both sides of a ring whatever they wait for: for the end of a connection.
void wakeRing(RingControl& control);

// Owned by the one thread that writes.
class RingWriter {
public:
    RingWriter(RingControl& control, std::byte* data, size_t capacityBytes);

    // Copies and publishes what fits now; returns how much that was.
    size_t write(std::span<const std::byte> bytes);
    [[nodiscard]] bool hasRoom() { return room(1) != 0; }
    // Wakes the reader if it sleeps.
    void announce();
    // Announces, then sleeps until the reader makes room, at most timeoutNs; may return early.
    void sleepUntilRoom(int64_t timeoutNs);

    [[nodiscard]] bool damaged() const { return damaged_; }
    [[nodiscard]] uint64_t wakeUps() const {
        return wakeUps_;
    } // system calls made to wake the reader

private:
    size_t room(size_t wantedBytes);
    void copyIn(std::span<const std::byte> bytes);

    RingControl& control_;
    std::byte* data_;
    uint32_t capacityBytes_;
    uint32_t pieceBytes_;    // published at once, so that both sides copy at the same time
    uint32_t announceBytes_; // published without a wake-up at most
    uint32_t tail_ = 0;
    uint32_t seenHead_ = 0;
    uint32_t unannouncedBytes_ = 0;
    uint64_t wakeUps_ = 0;
    bool damaged_ = false;
};

// Owned by the one thread that reads.
class RingReader {
public:
    RingReader(RingControl& control, const std::byte* data, size_t capacityBytes);

    // Takes what is there now, at most into.size(); returns how much that was.
    size_t read(std::span<std::byte> into);
    [[nodiscard]] bool hasData() { return available(1) != 0; }
    // Wakes the writer if it sleeps.
    void announce();
    // Announces, then sleeps until the writer has written, at most timeoutNs; may return early.
    void sleepUntilData(int64_t timeoutNs);

    [[nodiscard]] bool damaged() const { return damaged_; }
    [[nodiscard]] uint64_t wakeUps() const { return wakeUps_; }

private:
    size_t available(size_t wantedBytes);
    void copyOut(std::span<std::byte> into) const;

    RingControl& control_;
    const std::byte* data_;
    uint32_t capacityBytes_;
    uint32_t pieceBytes_;
    uint32_t announceBytes_;
    uint32_t head_ = 0;
    uint32_t seenTail_ = 0;
    uint32_t unannouncedBytes_ = 0;
    uint64_t wakeUps_ = 0;
    bool damaged_ = false;
};

} // namespace mural
