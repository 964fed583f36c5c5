// A single-producer single-consumer byte ring in memory shared by two threads or two processes.
//
// Positions are free-running 32-bit byte counts (capacity at most 1 GiB, so differences are unambiguous). They are
// futex words too: the reader sleeps on `tail`, the writer on `head`. A sleeping side sets its waiting flag, so a
// flowing stream costs no system call. Wake-ups are batched: after `announceBytes_`, at announce(), and before a side
// goes to sleep. A side must sleep in slices: the last bytes of a batch are visible immediately, but only announce()
// wakes for them.
//
// Each side keeps a private copy of its position, so a damaged or hostile peer cannot make it leave the ring; damaged()
// becomes true instead.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mural {

constexpr size_t kMinRingBytes = 64;
constexpr size_t kMaxRingBytes = size_t{1} << 30;

// Control block in shared memory. All zeros is a valid initial state.
struct RingControl {
    alignas(64) std::atomic<uint32_t> tail; // total bytes written
    alignas(64) std::atomic<uint32_t> head; // total bytes read
    alignas(64) std::atomic<uint32_t> readerWaiting;
    alignas(64) std::atomic<uint32_t> writerWaiting;
    alignas(64) std::atomic<uint32_t> writerClosed; // the writer has ended
    std::atomic<uint32_t> readerClosed;             // the reader has ended
};
static_assert(std::atomic<uint32_t>::is_always_lock_free, "needed between processes");

// Wakes both sides of a ring unconditionally, at the end of a connection.
void wakeRing(RingControl& control);

// Producer side. Owned by one thread.
class RingWriter {
public:
    RingWriter(RingControl& control, std::byte* data, size_t capacityBytes);

    // Copies and publishes as much as fits; returns the number of bytes.
    size_t write(std::span<const std::byte> bytes);
    [[nodiscard]] bool hasRoom() { return room(1) != 0; }
    // Wakes the reader if it sleeps.
    void announce();
    // Announces, then sleeps until there is room, for at most timeoutNs. Spurious returns are possible.
    void sleepUntilRoom(int64_t timeoutNs);

    [[nodiscard]] bool damaged() const { return damaged_; }
    [[nodiscard]] uint64_t wakeUps() const { return wakeUps_; } // system calls that woke the reader

private:
    size_t room(size_t wantedBytes);
    void copyIn(std::span<const std::byte> bytes);

    RingControl& control_;
    std::byte* data_;
    uint32_t capacityBytes_;
    uint32_t pieceBytes_;    // unit of publication, so both sides copy concurrently
    uint32_t announceBytes_; // bytes published between two wake-ups
    uint32_t tail_ = 0;
    uint32_t seenHead_ = 0;
    uint32_t unannouncedBytes_ = 0;
    uint64_t wakeUps_ = 0;
    bool damaged_ = false;
};

// Consumer side. Owned by one thread.
class RingReader {
public:
    RingReader(RingControl& control, const std::byte* data, size_t capacityBytes);

    // Reads available bytes, at most into.size(); returns their number.
    size_t read(std::span<std::byte> into);
    [[nodiscard]] bool hasData() { return available(1) != 0; }
    // Wakes the writer if it sleeps.
    void announce();
    // Announces, then sleeps until there is data, for at most timeoutNs. Spurious returns are possible.
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
